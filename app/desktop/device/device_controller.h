// Controller of the chosen device: connects it to the loop when it appears, notices when it goes,
// and takes it up again. The device has no force until the user arms it. Slow work is done beside
// the window.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/desktop/live/live_stage.h"
#include "app/device/device_hub.h"
#include "devices/device.h"

namespace limpid {

// URDF file and the tip in it.
struct NamedArm {
  std::string file, tip;
};

// Requests of the controller that change more than the loop.
struct DeviceRequests {
  std::function<void(std::unique_ptr<Device>)> open;  // opens this device in the loop
  // Puts the virtual arm in the device's place, after unsaved changes are settled; calls `then`
  // just before.
  std::function<void(std::function<void()> then)> close;
  std::function<void()> first_button, second_button;
  std::function<NamedArm()> open_arm;  // returns the window's arm, whatever device is in its place
};

class DeviceController {
 public:
  DeviceController(LiveStage& live, Notices& notices, AskForPriority ask, DeviceRequests requests)
      : live_(live),
        notices_(notices),
        hub_(device_store_file(), std::move(ask)),
        requests_(std::move(requests)) {}

  // Does the work of a frame; to be called once a frame.
  void update();
  // Notes that a device has just been given to the loop.
  void plugged();
  // Chooses another device; empty: the virtual arm. The present one loses its force at once, and
  // its place once the user has decided on unsaved changes.
  void use(const std::string& id);
  // Connects only to the user's choice from now on. `why`: a sentence for people.
  void wait_for_choice(std::string why) { waits_ = std::move(why); }
  // Returns whether the device in use is there, and the user may choose it by use().
  bool waits_for_choice() const;
  // Saves the notes on the device in use, after they have changed.
  void save();
  // Saves the notes, and connects the device anew.
  void connect_anew();

  const std::string& problem() const { return problem_; }  // why the device is not in the loop

  // Returns whether the device's axes have to be checked before it may push.
  bool awaits_check() const;
  void start_check();
  void cancel_check() {
    if (progress_) progress_->cancel = true;
  }
  bool check_failed() const { return check_failed_; }  // problem() says why
  // Returns the progress of the check; null: none runs.
  const AxisCheckProgress* check() const { return check_.valid() ? progress_.get() : nullptr; }

  // Notes which arm the device in use is, and connects it anew. The arm's file: kBuiltInArm, or a
  // file; empty: unknown.
  void say_arm(const NamedArm& arm);
  NamedArm open_arm() const { return requests_.open_arm(); }

  // Takes the device in use out of the loop, without force, until take_back().
  void lend();
  void take_back() { lent_ = false; }

  DeviceHub& hub() { return hub_; }
  const DeviceHub& hub() const { return hub_; }

 private:
  using Clock = std::chrono::steady_clock;

  void look();
  void say_what_came();
  void connect();
  bool still_wanted() const;  // the connection or check under way
  void take_connected();
  void watch();
  void follow_check();
  // Returns why the device is not connected at present, for people; empty: nothing prevents it.
  std::string obstacle() const;
  // Lets this window connect by itself if it is the first that has a device.
  void decide_who_chooses();
  void choose();
  void take_turn(const std::string& id);
  // Returns whether the device has to wait: a recording goes on only with the device it began with.
  bool must_wait() const;

  LiveStage& live_;
  Notices& notices_;
  DeviceHub hub_;
  DeviceRequests requests_;
  std::string problem_;
  Clock::time_point look_at_{}, services_at_{}, retry_at_{}, plugged_at_{};
  ButtonPresses buttons_;
  std::uint64_t trips_said_ = 0;  // of the loop's trips()
  std::future<std::vector<FoundDevice>> looking_;
  std::optional<std::vector<std::string>> known_;  // ids of the devices seen last; none: not asked
  bool asking_services_ = false, lent_ = false;
  std::future<std::unique_ptr<Device>> connecting_;
  std::string connecting_id_;
  std::string unchecked_;  // id of a device that proved to push when it was opened
  std::string waits_;      // why the user has to choose; empty: no need, or done
  bool decided_ = false;   // decide_who_chooses() has decided
  bool blocked_ = false;   // the problem is an obstacle
  std::future<AxisCheck> check_;
  std::shared_ptr<AxisCheckProgress> progress_;
  bool check_failed_ = false;  // the last one
};

}  // namespace limpid
