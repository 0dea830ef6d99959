#include "core/tick/motor_warmth.h"

#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"

namespace limpid {

double warm_limit(double peak, double continuous, double warmth) {
  if (!(continuous > 0) || continuous >= peak || !(warmth > kWarmFrom)) return peak;
  const double left = std::max(0.0, 1 - warmth) / (1 - kWarmFrom);
  const double most = continuous * continuous;
  return std::sqrt(most + left * (peak * peak - most));
}

template <int N>
MotorWarmth<N>::MotorWarmth(const ArmDescription& arm)
    : continuous_(of_joints<N>(arm, &Joint::continuous)),
      time_(of_joints<N>(arm, &Joint::warming)),
      warmth_(Vec<N>::Zero(arm.dof())),
      share_(warmth_) {
  any_ = (continuous_.array() > 0).any();
}

template <int N>
void MotorWarmth<N>::start(std::span<const double> warmth) {
  for (Eigen::Index i = 0; i < warmth_.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool warm = continuous_[i] > 0 && at < warmth.size() && warmth[at] > 0;
    warmth_[i] = warm ? std::min(warmth[at], 1.0) : 0;
  }
}

template <int N>
void MotorWarmth<N>::hold(const Vec<N>& tau, double time) {
  if (!any_ || !(time > 0)) return;
  if (time != step_) {
    step_ = time;
    for (Eigen::Index i = 0; i < time_.size(); ++i) {
      share_[i] = continuous_[i] > 0 ? 1 - exponential(-time / time_[i]) : 0;
    }
  }
  for (Eigen::Index i = 0; i < time_.size(); ++i) {
    if (!(continuous_[i] > 0) || !std::isfinite(tau[i])) continue;
    const double goal = tau[i] / continuous_[i];
    warmth_[i] += share_[i] * (goal * goal - warmth_[i]);
  }
}

template <int N>
void MotorWarmth<N>::limit(Vec<N>& limits) const {
  if (!any_) return;
  for (Eigen::Index i = 0; i < limits.size(); ++i) {
    limits[i] = warm_limit(limits[i], continuous_[i], std::max(warmth_[i], reported_));
  }
}

template class MotorWarmth<3>;
template class MotorWarmth<7>;
template class MotorWarmth<kAnyDof>;

}  // namespace limpid
