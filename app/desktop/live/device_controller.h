// Keeps the chosen device in the loop: connects it when it is there, notices when it goes, takes it
// up again when it comes back, always without force until the user arms it. What takes time is done
// beside the window.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/live/live_session.h"
#include "app/device/device_hub.h"
#include "devices/device.h"

namespace limpid {

// A URDF and the tip in it.
struct NamedArm {
  std::string file, tip;
};

// What it asks for that changes more than the loop.
struct DeviceRequests {
  std::function<void(std::unique_ptr<Device>)> open;  // this device into the loop
  // The virtual arm by the mouse; `then` just before, once nothing that is not saved keeps the
  // device in the loop.
  std::function<void(std::function<void()> then)> close;
  std::function<void()> first_button, second_button;
  std::function<NamedArm()> open_arm;  // that the window has, whatever device is in its place
};

class DeviceController {
 public:
  DeviceController(LiveSession& live, Notices& notices, AskForPriority ask, DeviceRequests requests)
      : live_(live),
        notices_(notices),
        hub_(device_store_file(), std::move(ask)),
        requests_(std::move(requests)) {}

  // Once a frame.
  void update();
  // A device has just been given to the loop.
  void plugged();
  // Another device; empty: the virtual arm. The one in the loop loses its force at once, and its
  // place when the user has said what becomes of changes that are not saved.
  void use(const std::string& id);
  // From now on it connects to what the user chooses only; `why`, for people: a sentence.
  void wait_for_choice(std::string why) { waits_ = std::move(why); }
  // The device in use is there, and the user may choose it by use().
  bool waits_for_choice() const;
  // After the notes on the device in use have changed.
  void save();
  // The same, where it has to be connected anew for it.
  void connect_anew();

  const std::string& problem() const { return problem_; }  // why it is not in the loop

  // The check of a device's axes, which has to come before it may push.
  bool awaits_check() const;
  void start_check();
  void cancel_check() {
    if (progress_) progress_->cancel = true;
  }
  // What goes on in it; null: none does.
  const AxisCheckProgress* check() const { return check_.valid() ? progress_.get() : nullptr; }

  // Which arm the device in use is: kBuiltInArm, or a file; empty: nobody has said. It is connected
  // anew for it.
  void say_arm(const NamedArm& arm);
  NamedArm open_arm() const { return requests_.open_arm(); }

  // The device in use leaves the loop, without force, and stays away until it is taken back.
  void lend();
  void take_back() { lent_ = false; }

  DeviceHub& hub() { return hub_; }
  const DeviceHub& hub() const { return hub_; }

 private:
  using Clock = std::chrono::steady_clock;

  void look();
  void say_what_came();
  void connect();
  void take_connected();
  void watch();
  void follow_check();
  // Why it is not connected to at present, for people; empty: nothing keeps it from that.
  std::string obstacle() const;
  // The first window that has a device connects to it by itself.
  void decide_who_chooses();
  void choose();
  void take_turn(const std::string& id);
  // A recording goes on with the device that it began with only.
  bool must_wait() const;

  LiveSession& live_;
  Notices& notices_;
  DeviceHub hub_;
  DeviceRequests requests_;
  std::string problem_;
  Clock::time_point look_at_{}, services_at_{}, retry_at_{}, plugged_at_{};
  ButtonPresses buttons_;
  Arming arming_ = Arming::off;  // at the last frame
  std::future<std::vector<FoundDevice>> looking_;
  std::optional<std::vector<std::string>> known_;  // ids of those that were there; none: not asked
  bool asking_services_ = false, lent_ = false;
  std::future<std::unique_ptr<Device>> connecting_;
  std::string connecting_id_;
  std::string unchecked_;  // id of one that pushes, as its opening has shown
  std::string waits_;      // why the user has to choose; empty: need not, or has chosen
  bool decided_ = false;   // whether the user has to
  bool blocked_ = false;   // the problem is an obstacle
  std::future<AxisCheck> check_;
  std::shared_ptr<AxisCheckProgress> progress_;
};

}  // namespace limpid
