// Keeps the chosen device in the loop: connects it when it is there, notices when it goes, takes it
// up again when it comes back, always without force until the user arms it. What takes time is done
// beside the window.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "app/device/device_hub.h"
#include "devices/buttons.h"

namespace limpid {

class Workbench;

class DeviceDesk {
 public:
  explicit DeviceDesk(AskForPriority ask);

  // Once a frame.
  void update(Workbench& bench);
  // A device has just been given to the loop.
  void plugged();
  // Another device; empty: the virtual arm.
  void use(Workbench& bench, const std::string& id);
  // After the notes on the device in use have changed.
  void save(Workbench& bench) const;
  // The same, where it has to be connected anew for it.
  void connect_anew(Workbench& bench);

  const std::string& problem() const { return problem_; }  // why it is not in the loop

  // The check of a joystick's axes, which has to come before it may push.
  bool awaits_check() const { return hub.needs_check() && !check_.valid(); }
  void start_check(Workbench& bench);
  void cancel_check() {
    if (talk_) talk_->cancel = true;
  }
  // What goes on in it; null: none does.
  const AxisCheckTalk* check() const { return check_.valid() ? talk_.get() : nullptr; }

  DeviceHub hub;

 private:
  using Clock = std::chrono::steady_clock;

  void look(Workbench& bench);
  void connect(Workbench& bench);
  void take_connected(Workbench& bench);
  void watch(Workbench& bench);
  void follow_check(Workbench& bench);
  // A recording goes on with the device that it began with only.
  bool must_wait(const Workbench& bench) const;

  std::string problem_;
  Clock::time_point look_at_{}, retry_at_{}, plugged_at_{};
  ButtonPresses buttons_;
  Arming arming_ = Arming::off;  // at the last frame
  std::future<std::vector<FoundDevice>> looking_;
  std::future<std::unique_ptr<Device>> connecting_;
  std::string connecting_id_;
  std::future<AxisCheck> check_;
  std::shared_ptr<AxisCheckTalk> talk_;
};

}  // namespace limpid
