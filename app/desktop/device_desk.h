// Keeps the chosen device in the loop: connects it when it is there, notices when it goes, takes it
// up again when it comes back, always without force until the user arms it.
#pragma once

#include <chrono>
#include <string>

#include "app/device/device_hub.h"

namespace limpid {

class Workbench;

class DeviceDesk {
 public:
  explicit DeviceDesk(AskForPriority ask);

  // Once a frame.
  void update(Workbench& bench);
  // Another device; empty: the virtual arm.
  void use(Workbench& bench, const std::string& id);
  // After the notes on the device in use have changed.
  void connect_anew(Workbench& bench);

  const std::string& problem() const { return problem_; }  // why it is not in the loop

  DeviceHub hub;

 private:
  using Clock = std::chrono::steady_clock;

  void connect(Workbench& bench);
  void watch(Workbench& bench);

  std::string problem_;
  Clock::time_point look_at_{}, retry_at_{}, plugged_at_{};
  std::uint32_t buttons_ = 0;
};

}  // namespace limpid
