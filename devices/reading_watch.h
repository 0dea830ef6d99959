// Plausibility of a device's readings: whether it can be where they say.
#pragma once

#include "devices/device.h"

namespace limpid {

// Judges readings before any law, observer or account of energy sees them, whatever their protocol.
// A reading can arrive whole and be wrong: a counter that loses a turn, a flipped bit. It has to
// lie in the device's range, and no farther from the last believed reading than the fastest joint
// can go (safety_limits.h). The believed one may have been up to kStaleReading old when it was
// read.
class ReadingWatch {
 public:
  // Begins with a device just plugged in: its first reading is judged by its range alone.
  void start() { *this = {}; }

  void wait(double dt) noexcept { since_ += dt; }  // lets time pass [s]
  // Returns whether this reading, the newest one, is believed. The verdict holds until another
  // reading comes.
  bool believes(const DeviceReading& now, const DeviceTraits& traits) noexcept;

 private:
  std::array<double, kMaxDof> judged_{}, last_{};  // judged last; believed last [rad]
  std::uint64_t count_ = 0;                        // of the reading judged last
  double since_ = 0;                               // time since the last believed new reading [s]
  bool any_ = false, believed_ = true;
};

// Returns whether every position is finite and at most kOutside beyond the device's range.
bool within_reach(const DeviceReading& reading, const DeviceTraits& traits) noexcept;

}  // namespace limpid
