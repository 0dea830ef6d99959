// The last stage before the motors: torques leave finite, within limits, and without jumps.
#pragma once

#include <limits>

#include "core/dynamics/torque_limits.h"

namespace limpid {

// Clamps the torque; where motors are guarded it bounds its growth as well. It falls at once:
// torque that goes on after a wall was left gives the hand energy that no law has counted. While a
// coupling is being switched the torque moves at a bounded rate, up and down, until it meets the
// new command, for 0.2 s at most.
template <int N>
class MotorStage {
 public:
  explicit MotorStage(Eigen::Index n) : tau_(Vec<N>::Zero(n)) {}

  void start() {
    tau_.setZero();
    slewing_ = false;
  }
  void begin_slew() {
    slewing_ = true;
    slewed_ = 0;
  }
  void end_slew() { slewing_ = false; }
  bool steady() const { return !slewing_; }

  // Returns the motors' torque for this command [N m]. `gain`: the part of the limited torque that
  // may leave, 0 to 1; at 0 the torque is zero at once. `slew`: least time from no torque to a
  // joint's limit, always in force [s]; 0: only while a coupling is being switched. `dt`: time
  // since the last torque left [s].
  const Vec<N>& pass(const Vec<N>& command, const TorqueLimits<N>& limits, double gain, double dt,
                     double slew = 0) {
    Vec<N> target = gain * limits.within(command);
    if (!(gain > 0) || command.hasNaN() || !target.allFinite()) {
      start();
      return tau_;
    }
    if (slewing_ || slew > 0) approach(target, limits, dt, slew);
    tau_ = target;
    return tau_;
  }

 private:
  // Moves the target to where the torque may be by now.
  [[gnu::noinline]] void approach(Vec<N>& target, const TorqueLimits<N>& limits, double dt,
                                  double slew) {
    // Straight towards `target`, all joints together: both ends are within the limits, and so is
    // all between. The last torque may be outside them if limits or pose changed.
    Vec<N> from = limits.within(tau_);
    if (!slewing_) {
      from = from.cwiseMax(target.cwiseMin(0.0)).cwiseMin(target.cwiseMax(0.0));
      from = limits.within(from);
    }
    const Vec<N> way = target - from;
    const Vec<N> step = limits.joints * (dt / (slewing_ ? kSlew : slew));
    // For the slowest joint; a joint without a motor has neither way nor step.
    const double steps =
        way.cwiseAbs().cwiseQuotient(step.cwiseMax(std::numeric_limits<double>::min())).maxCoeff();
    slewed_ += dt;
    slewing_ = slewing_ && steps > 1 && slewed_ < kLongestSlew;
    if (steps > 1) target = from + way / steps;
  }

  static constexpr double kSlew = 0.1;  // from no torque to the limit [s]
  // Time from one limit to the other: a command that swings faster is never met.
  static constexpr double kLongestSlew = 2 * kSlew;

  Vec<N> tau_;
  bool slewing_ = false;
  double slewed_ = 0;  // time since begin_slew() [s]
};

}  // namespace limpid
