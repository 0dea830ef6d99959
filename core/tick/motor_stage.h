// The last stage before the motors: torques leave finite, within limits, and without jumps.
#pragma once

#include "core/dynamics/arm.h"

namespace limpid {

// How much torque may leave for the motors: so much a joint, and so much force at the tip.

// The smallest force at the tip that makes this torque, as far as a force there can [N].
template <int N>
double tip_force(const Vec<N>& tau, const Jacobian<N>& J);

// Both limits leave convex sets of torques about zero: a torque between two that are allowed is
// allowed, and so is a part of one.
template <int N>
struct TorqueLimits {
  // Without a limit for the tip.
  TorqueLimits(const Vec<N>& most) : joints(most) {}  // NOLINT(google-explicit-constructor)
  TorqueLimits(const Vec<N>& most, const Jacobian<N>& tip, double force)
      : joints(most), J(&tip), most_force(force) {}

  // Each joint to its limit, then all of them by one factor to that of the tip: the factor takes no
  // joint beyond its limit again.
  Vec<N> within(const Vec<N>& tau) const {
    const Vec<N> held = tau.cwiseMin(joints).cwiseMax(-joints);
    const double force = J != nullptr ? tip_force<N>(held, *J) : 0;
    return force > most_force ? Vec<N>(held * (most_force / force)) : held;
  }

  const Vec<N>& joints;            // > 0 [N m]
  const Jacobian<N>* J = nullptr;  // of the tip
  double most_force = 0;           // [N]
};

extern template double tip_force<3>(const Vec<3>&, const Jacobian<3>&);
extern template double tip_force<7>(const Vec<7>&, const Jacobian<7>&);
extern template double tip_force<kAnyDof>(const Vec<kAnyDof>&, const Jacobian<kAnyDof>&);

// At rest it only clamps; where motors are guarded it bounds the rate as well. While a coupling is
// being switched the torque moves at a bounded rate until it meets the new command, for 0.2 s at
// most.
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
  bool steady() const { return !slewing_; }

  // The torque the motors get for this command [N m]. `gain`: the part of what is within the limits
  // that may leave, 0 to 1; at 0 it is zero at once. `slew`: from no torque to a joint's limit,
  // always [s]; 0: only while a coupling is being switched. `dt`: since the last torque left [s].
  const Vec<N>& pass(const Vec<N>& command, const TorqueLimits<N>& limits, double gain, double dt,
                     double slew = 0) {
    Vec<N> target = gain * limits.within(command);
    if (!(gain > 0) || command.hasNaN() || !target.allFinite()) {
      start();
      return tau_;
    }
    if (slewing_ || slew > 0) {
      // Straight towards it, all joints together: both ends of the way are within the limits, and
      // so is what lies between. The last torque may no longer be, where limits or pose changed.
      const Vec<N> from = limits.within(tau_);
      const Vec<N> way = target - from;
      const Vec<N> step = limits.joints * (dt / (slewing_ ? kSlew : slew));
      const double steps = way.cwiseAbs().cwiseQuotient(step).maxCoeff();  // for the slowest joint
      slewed_ += dt;
      slewing_ = slewing_ && steps > 1 && slewed_ < kLongestSlew;
      if (steps > 1) target = from + way / steps;
    }
    tau_ = target;
    return tau_;
  }

 private:
  static constexpr double kSlew = 0.1;  // from no torque to the limit [s]
  // As long as from one limit to the other: a command that swings faster is never met.
  static constexpr double kLongestSlew = 2 * kSlew;

  Vec<N> tau_;
  bool slewing_ = false;
  double slewed_ = 0;  // for how long [s]
};

}  // namespace limpid
