#include "app/live/device_look.h"

#include <algorithm>
#include <cmath>

#include "core/realtime/clock.h"

namespace limpid {
namespace {

constexpr double kDriftOfNoise = 0.25;  // of the span of noise, between the halves of a window
constexpr double kStillSteps = 8;       // of the encoder, within which a joint may stand still
constexpr double kStillPart = 1e-3;     // of the range, likewise
constexpr std::uint64_t kLeastInHalf = 4;

double still_within(const DeviceTraits& traits, std::size_t joint) {
  double still = 0;
  if (joint < traits.resolution.size()) still = kStillSteps * traits.resolution[joint];
  if (joint < traits.lower.size() && joint < traits.upper.size()) {
    still = std::max(still, kStillPart * (traits.upper[joint] - traits.lower[joint]));
  }
  return still;
}

}  // namespace

void RestNoise::add(double x, double time, double still) noexcept {
  if (open_ && time - began_ >= kWindow) end_window(still);
  if (!open_) {
    open_ = true;
    began_ = time;
    first_ = x;
    least_ = most_ = squares_ = 0;
    sum_ = {};
    count_ = {};
  }
  const std::size_t half = time - began_ < kWindow / 2 ? 0 : 1;
  const double off = x - first_;
  least_ = std::min(least_, off);
  most_ = std::max(most_, off);
  squares_ += off * off;
  sum_[half] += off;
  ++count_[half];
}

void RestNoise::end_window(double still) noexcept {
  open_ = false;
  if (std::min(count_[0], count_[1]) < kLeastInHalf) return;
  const double span = most_ - least_;
  const auto n0 = static_cast<double>(count_[0]), n1 = static_cast<double>(count_[1]);
  if (span > still || std::abs(sum_[1] / n1 - sum_[0] / n0) > kDriftOfNoise * span) return;
  const double mean = (sum_[0] + sum_[1]) / (n0 + n1);
  variance_ += std::max(0.0, squares_ / (n0 + n1) - mean * mean);
  ++windows_;
}

std::optional<double> RestNoise::rms() const noexcept {
  if (windows_ == 0) return std::nullopt;
  return std::sqrt(variance_ / static_cast<double>(windows_));
}

void DeviceSeen::take(const DeviceReading& reading, bool here, const DeviceTraits& traits,
                      double now) noexcept {
  const double dt = looked_at_ > 0 ? now - looked_at_ : 0;
  looked_at_ = now;
  gone = !here;
  if (!here) return;
  take_state(reading, dt);
  if (reading.count == 0) return;
  watch_.wait(dt);
  const double arrived = now - reading.age;
  // Nothing came since it did.
  if (count_ > 0) worst_gap_ = std::max(worst_gap_, reading.age);
  if (count_ > 0 && reading.count == newest_) return;
  const std::uint64_t since = count_ > 0 ? reading.count - newest_ : 1;
  if (count_ > 0) {
    gaps_.add((arrived - last_) / static_cast<double>(since));
    if (since == 1) worst_gap_ = std::max(worst_gap_, arrived - last_);
  } else {
    first_ = arrived;
    watch_.start();
  }
  count_ += since;
  newest_ = reading.count;
  last_ = arrived;
  if (watch_.believes(reading, traits)) {
    take_positions(reading, traits, arrived);
  } else {
    ++unbelieved;
  }
}

// A device may say these without a position.
void DeviceSeen::take_state(const DeviceReading& reading, double dt) noexcept {
  without_hand += reading.hand ? 0 : dt;
  fault += reading.fault && reading.calibrated ? dt : 0;  // a device is in fault until calibrated
  uncalibrated += reading.calibrated ? 0 : dt;
  no_force[static_cast<std::size_t>(reading.no_force)] += dt;
  buttons |= reading.buttons;
  warmth = std::max(warmth, reading.warmth);
}

void DeviceSeen::take_positions(const DeviceReading& reading, const DeviceTraits& traits,
                                double time) noexcept {
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits.dof); ++i) {
    JointSeen& joint = joints_[i];
    const double x = reading.x[i];
    const double step = std::abs(x - before_[i]);
    if (std::isfinite(joint.least) && step > 0) joint.step = std::min(joint.step, step);
    joint.least = std::min(joint.least, x);
    joint.most = std::max(joint.most, x);
    joint.noise.add(x, time, still_within(traits, i));
    before_[i] = x;
  }
}

bool OnlyLooked::read(DeviceReading& newest) noexcept {
  const bool here = device_->read(newest);
  if (seen_->noting) {
    seen_->take(newest, here, device_->traits(), in_seconds(MonotonicTime{}.now()));
  }
  return here;
}

}  // namespace limpid
