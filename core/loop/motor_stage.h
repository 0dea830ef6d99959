// The last stage before the motors: torques leave finite, within limits, and without jumps.
#pragma once

#include <algorithm>

#include "core/math/sizes.h"

namespace limpid {

// At rest it only clamps; where motors are real it bounds the rate as well. While a coupling is
// being switched the torque moves at a bounded rate until it meets the new command; when force is
// armed it fades in; when cut it is zero at once.
template <int N>
class MotorStage {
 public:
  explicit MotorStage(Eigen::Index n) : tau_(Vec<N>::Zero(n)) {}

  void start(bool armed) {
    tau_.setZero();
    gain_ = armed ? 1 : 0;
    slewing_ = false;
  }
  void begin_slew() { slewing_ = true; }
  bool steady(bool wanted) const { return !slewing_ && gain_ == (wanted ? 1.0 : 0.0); }

  // The torque the motors get for this command [N m]; limit > 0 for each joint. `ceiling`: the
  // part of it that may leave, 0 to 1. `slew`: from no torque to the limit, always [s]; 0: only
  // while a coupling is being switched.
  const Vec<N>& pass(const Vec<N>& command, const Vec<N>& limit, bool wanted, double T,
                     double ceiling = 1, double slew = 0) {
    gain_ = wanted ? std::min(ceiling, gain_ + T / kFade) : 0.0;
    Vec<N> target = (gain_ * command).cwiseMin(limit).cwiseMax(-limit);
    if (!wanted || !target.allFinite()) {
      tau_.setZero();
      slewing_ = false;
      return tau_;
    }
    if (slewing_ || slew > 0) {
      const Vec<N> step = limit * (T / (slewing_ ? kSlew : slew));
      const Vec<N> slewed = (target - tau_).cwiseMin(step).cwiseMax(-step) + tau_;
      slewing_ = slewing_ && (slewed - target).cwiseAbs().maxCoeff() > 0;
      target = slewed;
    }
    tau_ = target;
    return tau_;
  }

 private:
  static constexpr double kFade = 0.5;  // from no force to full force [s]
  static constexpr double kSlew = 0.1;  // from no torque to the limit [s]

  Vec<N> tau_;
  double gain_ = 1;
  bool slewing_ = false;
};

}  // namespace limpid
