// Every torque that a reference device received or that began to act, with its time.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <vector>

namespace limpid::test {

using Time = std::chrono::nanoseconds;  // of the steady clock, or of a simulated one
inline constexpr std::size_t kAxes = 6;
using Torque = std::array<double, kAxes>;  // [N m]

enum class ForceCause {
  told,      // the host sent it, possibly the same value again
  expired,   // an effect came to its end
  watchdog,  // the device missed the host and cut the torque by itself
  power,     // plugged in or out
};

struct ForceSample {
  Time time{};
  Torque torque{};  // acts from this time on
  ForceCause cause = ForceCause::told;
};

class ForceLog {
 public:
  void note(Time time, const Torque& torque, ForceCause cause) {
    samples_.push_back({time, torque, cause});
  }
  void clear() { samples_.clear(); }
  // Reserves memory for long runs: growing would delay the device.
  void expect(std::size_t samples) { samples_.reserve(samples); }
  std::span<const ForceSample> samples() const { return samples_; }
  Torque newest() const { return samples_.empty() ? Torque{} : samples_.back().torque; }

  // Time from `failure` to the end of the last torque: 0 if none acted, nothing if one still does.
  std::optional<Time> zero_after(Time failure) const;
  // The largest |torque| of any axis that acted at or after `from` [N m].
  double largest(Time from = Time::min()) const;
  // The longest time between two messages of the host from `from` to `to`.
  Time longest_silence(Time from, Time to) const;

 private:
  std::vector<ForceSample> samples_;
};

}  // namespace limpid::test
