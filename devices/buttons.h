// What a device's buttons ask for.
#pragma once

#include <cstdint>

namespace limpid {

// A button counts when it goes down after it was seen up: one that is held while the device is
// plugged in asks for nothing.
class ButtonPresses {
 public:
  void forget() { down_ = ~0u; }

  // Those that went down since the last call; one bit each, as in DeviceReading.
  std::uint32_t take(std::uint32_t now) {
    const std::uint32_t pressed = now & ~down_;
    down_ = now;
    return pressed;
  }

 private:
  std::uint32_t down_ = ~0u;
};

}  // namespace limpid
