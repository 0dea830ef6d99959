// Whether a device can be where its readings say that it is.
#pragma once

#include "devices/device.h"

namespace limpid {

// A reading can arrive whole and be wrong: a counter that loses a turn, a bit that falls over. Such
// a reading is not to reach a law, an observer or an account of energy, so it is judged before all
// of them, whatever protocol it came by: by the range that the device says it has, and by how far
// its fastest joint can have gone since the last one that was believed (safety_limits.h). That one
// may have been up to kStaleReading old when it was read.
class ReadingWatch {
 public:
  // Begins with a device that was just plugged in: its first reading is judged by its range alone.
  void start() { *this = {}; }

  void wait(double dt) noexcept { since_ += dt; }  // so much time passes [s]
  // Whether this reading, the newest one, is believed. One that is not stays so until another one
  // comes.
  bool believes(const DeviceReading& now, const DeviceTraits& traits) noexcept;

 private:
  std::array<double, kMaxDof> judged_{}, last_{};  // last: of those believed [rad]
  std::uint64_t count_ = 0;                        // of the one judged last
  double since_ = 0;                               // the last believed one was new [s]
  bool any_ = false, believed_ = true;
};

// Whether every joint is somewhere, and no further beyond the device's range than kOutside.
bool within_reach(const DeviceReading& reading, const DeviceTraits& traits) noexcept;

}  // namespace limpid
