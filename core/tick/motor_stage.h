// The last stage before the motors: torques leave finite, within limits, and without jumps.
#pragma once

#include <algorithm>

#include "core/math/sizes.h"

namespace limpid {

// At rest it only clamps; where motors are guarded it bounds the rate as well. While a coupling is
// being switched the torque moves at a bounded rate until it meets the new command.
template <int N>
class MotorStage {
 public:
  explicit MotorStage(Eigen::Index n) : tau_(Vec<N>::Zero(n)) {}

  void start() {
    tau_.setZero();
    slewing_ = false;
  }
  void begin_slew() { slewing_ = true; }
  bool steady() const { return !slewing_; }

  // The torque the motors get for this command [N m]; limit > 0 for each joint. `gain`: the part of
  // what is within the limits that may leave, 0 to 1; at 0 it is zero at once. `slew`: from no
  // torque to the limit, always [s]; 0: only while a coupling is being switched. `dt`: since the
  // last torque left [s].
  const Vec<N>& pass(const Vec<N>& command, const Vec<N>& limit, double gain, double dt,
                     double slew = 0) {
    Vec<N> target = gain * command.cwiseMin(limit).cwiseMax(-limit);
    if (!(gain > 0) || !target.allFinite()) {
      start();
      return tau_;
    }
    if (slewing_ || slew > 0) {
      const Vec<N> step = limit * (dt / (slewing_ ? kSlew : slew));
      const Vec<N> slewed = (target - tau_).cwiseMin(step).cwiseMax(-step) + tau_;
      slewing_ = slewing_ && (slewed - target).cwiseAbs().maxCoeff() > 0;
      target = slewed;
    }
    tau_ = target;
    return tau_;
  }

 private:
  static constexpr double kSlew = 0.1;  // from no torque to the limit [s]

  Vec<N> tau_;
  bool slewing_ = false;
};

}  // namespace limpid
