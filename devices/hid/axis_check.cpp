#include "devices/hid/axis_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace limpid {
namespace {

constexpr double kShare = 0.1;     // part of full force, at most
constexpr double kFadeIn = 0.5;    // time in which the torque grows [s]
constexpr double kLongest = 0.7;   // longest push [s]
constexpr double kStill = 0.2;     // rest without a motion [s]
constexpr double kPatience = 0.5;  // longest wait for a rest [s]; 3 rests and 2 pushes are 2.9 s
constexpr double kEnough = 0.01;   // part of the axis' whole way
constexpr double kAllowed = 0.15;  // part of the axis' whole way
constexpr double kSteps = 8;       // least kEnough, in steps of the encoder
constexpr double kSudden = 0.015;  // a motion before this is not the small torque's [s]
constexpr double kClear = 2;       // least ratio of the axis' motion to any other's
constexpr double kAfterStall = 0.001;  // counted of a stall, in which nobody looked [s]
constexpr int kMostAgain = 5;          // pushes interrupted, of all axes
constexpr int kPhases = 5;

constexpr bool is_push(int phase) { return phase % 2 == 1; }

}  // namespace

const char* explain(AxisVerdict verdict) {
  switch (verdict) {
    case AxisVerdict::unknown: return "The axis has not been pushed yet.";
    case AxisVerdict::right: return "The axis moves in the direction of the push.";
    case AxisVerdict::reversed:
      return "The axis moves against the push; Limpid will reverse the sign of this axis's force.";
    case AxisVerdict::wrong_axis:
      return "Another axis moved: this device pushes along its axes in a way Limpid does not know, "
             "so it cannot be used as an arm.";
    case AxisVerdict::nothing_moved:
      return "The axis did not move in both directions. Hold the device less firmly, near its "
             "middle, and try again. A gamepad whose motors only shake the hand is not an arm.";
    case AxisVerdict::too_far:
      return "The axis moved further or faster than so little force should move it. Its full force "
             "is larger than declared, or the device does not follow commands. The device cannot "
             "be used as an arm.";
    case AxisVerdict::restless:
      return "The axis moved without a push. Let go of the device, or hold the device still, and "
             "try again.";
    case AxisVerdict::no_motor: return "The axis has no motor.";
    case AxisVerdict::beyond_limit:
      return "The axis passed a limit of speed, range or energy. Bring the device near its middle, "
             "let go or hold the device lightly, and try again.";
    case AxisVerdict::stalled:
      return "Several pushes were interrupted, because this computer or the device did not respond "
             "for more than 5 ms. Close other programs, and try again.";
    case AxisVerdict::given_up: return "The check was interrupted; nothing is stored.";
  }
  return "";
}

const char* what_to_do(AxisStage stage) {
  switch (stage) {
    case AxisStage::resting:
      return "Bring the device near its middle and let go, or hold the device lightly.";
    case AxisStage::pushing:
      return "First of two pushes: the motor pushes the axis a little. Do not resist the motion.";
    case AxisStage::pushing_back:
      return "Second of two pushes: the motor pushes the axis the other way. Do not resist the "
             "motion.";
    case AxisStage::done: return "";
  }
  return "";
}

AxisCheck::AxisCheck(const DeviceTraits& traits) : device_(traits.name), dof_(traits.dof) {
  const auto joints = static_cast<std::size_t>(traits.dof);
  const auto all = {traits.lower.size(), traits.upper.size(), traits.effort.size()};
  if (!traits.pushes || joints < 1 || joints > kMaxDof || std::min(all) < joints) {
    throw std::invalid_argument("a device without motors cannot be checked");
  }
  for (std::size_t i = 0; i < joints; ++i) {
    const double step = i < traits.resolution.size() ? traits.resolution[i] : 0;
    const double way = traits.upper[i] - traits.lower[i];
    if (!(way > 0 && traits.effort[i] >= 0)) {
      throw std::invalid_argument(
          "a joint with an empty range cannot be checked; needed: a range above 0");
    }
    most_[i] = kShare * traits.effort[i];
    if (most_[i] == 0) {  // the hand may move it as it likes
      enough_[i] = allowed_[i] = std::numeric_limits<double>::infinity();
      findings_[i].verdict = AxisVerdict::no_motor;
      continue;
    }
    enough_[i] = std::max(kEnough * way, kSteps * step);
    allowed_[i] = std::max(kAllowed * way, 2 * enough_[i]);
  }
  skip_axes_without_motor();
  if (done_) throw std::invalid_argument("a device without motors cannot be checked");
}

// Goes on to the next axis that has a motor, from this one on; ends the check if there is none.
void AxisCheck::skip_axes_without_motor() noexcept {
  while (axis_ < dof_ && most_[static_cast<std::size_t>(axis_)] == 0) ++axis_;
  if (axis_ < dof_) return;
  axis_ = dof_ - 1;
  done_ = true;
}

AxisStage AxisCheck::stage() const {
  if (done_) return AxisStage::done;
  if (!is_push(phase_)) return AxisStage::resting;
  return phase_ == 1 ? AxisStage::pushing : AxisStage::pushing_back;
}

bool AxisCheck::passed() const {
  return std::all_of(findings_.begin(), findings_.begin() + dof_, [](const AxisFinding& one) {
    return one.verdict == AxisVerdict::right || one.verdict == AxisVerdict::reversed ||
           one.verdict == AxisVerdict::no_motor;
  });
}

double AxisCheck::gone(int axis, const Joints& from, const Joints& limits) const noexcept {
  const auto i = static_cast<std::size_t>(axis);
  return (x_[i] - from[i]) / limits[i];
}

double AxisCheck::furthest(const Joints& from, const Joints& limits) const noexcept {
  double most = 0;
  for (int i = 0; i < dof_; ++i) most = std::max(most, std::abs(gone(i, from, limits)));
  return most;
}

std::span<const double> AxisCheck::step(const Tick& in) noexcept {
  const auto joints = static_cast<std::size_t>(dof_);
  bool sound = in.well && in.T > 0 && in.x.size() >= joints;
  for (std::size_t i = 0; sound && i < joints; ++i) sound = std::isfinite(in.x[i]);
  if (!done_ && !sound) end(AxisVerdict::given_up);
  if (!done_) {
    std::copy_n(in.x.begin(), joints, x_.begin());
    if (!started_) start_ = x_;
    started_ = true;
    const double T = in.gap ? std::min(in.T, kAfterStall) : in.T;
    time_ += T;
    if (in.gap && is_push(phase_)) rest_again();
    if (done_) return {torque_.data(), joints};
    if (phase_ > 0 && furthest(home_, allowed_) > 1) {
      end(AxisVerdict::too_far);
    } else if (is_push(phase_)) {
      push();
    } else {
      rest(T);
    }
  }
  return {torque_.data(), joints};
}

// Goes back to the rest before this push, a few times.
void AxisCheck::rest_again() noexcept {
  if (++again_ > kMostAgain) return end(AxisVerdict::stalled);
  --phase_;
  torque_.fill(0);
  time_ = still_ = 0;
  start_ = x_;
}

void AxisCheck::rest(double T) noexcept {
  still_ += T;
  if (furthest(start_, enough_) > 0.5) {
    start_ = x_;
    still_ = 0;
  }
  if (still_ >= kStill) return next();
  if (time_ >= kPatience) end(AxisVerdict::restless);
}

void AxisCheck::push() noexcept {
  if (furthest(start_, enough_) > 1) return judge();
  if (time_ >= kLongest) return end(AxisVerdict::nothing_moved);
  const auto i = static_cast<std::size_t>(axis_);
  const double grown = std::min(1.0, time_ / kFadeIn);
  torque_[i] = (phase_ == 1 ? 1 : -1) * grown * most_[i];
}

// Judges a motion: whether it was of this axis, and in the same sense of its torque both times.
void AxisCheck::judge() noexcept {
  const auto i = static_cast<std::size_t>(axis_);
  const double mine = gone(axis_, start_, enough_);
  for (int other = 0; other < dof_; ++other) {
    if (other == axis_) continue;
    if (std::abs(mine) < kClear * std::abs(gone(other, start_, enough_))) {
      return end(AxisVerdict::wrong_axis);
    }
  }
  if (torque_[i] == 0) return end(AxisVerdict::restless);  // before it was pushed
  if (time_ < kSudden) return end(AxisVerdict::too_far);
  const double moved_per_torque = (x_[i] - start_[i]) / torque_[i];
  const int sense = moved_per_torque > 0 ? 1 : -1;
  if (phase_ == 1) {
    sense_ = sense;
    found().moved_per_torque = std::abs(moved_per_torque);
  } else {
    if (sense != sense_) return end(AxisVerdict::restless);
    found().moved_per_torque = (found().moved_per_torque + std::abs(moved_per_torque)) / 2;
  }
  next();
}

// Goes on to the axis' next phase, after the last of which it is trusted, or to the next axis.
void AxisCheck::next() noexcept {
  torque_.fill(0);
  time_ = still_ = 0;
  start_ = x_;
  if (phase_ == 0) home_ = x_;
  if (++phase_ < kPhases) return;
  found().verdict = sense_ > 0 ? AxisVerdict::right : AxisVerdict::reversed;
  phase_ = 0;
  ++axis_;
  skip_axes_without_motor();
}

void AxisCheck::end(AxisVerdict verdict) noexcept {
  torque_.fill(0);
  if (done_) return;
  found().verdict = verdict;
  done_ = true;
}

}  // namespace limpid
