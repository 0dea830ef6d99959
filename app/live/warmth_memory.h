// Warmth of the motors of devices in the arm's place, from one loop to the next.
#pragma once

#include <map>

#include "core/dynamics/arm_description.h"
#include "core/math/elementary.h"

namespace limpid {

// Keeps it by the number of joints: a device that comes in another's place counts as warm as that
// one, so nothing is forgotten, whatever a device calls itself.
class WarmthMemory {
 public:
  // `now` [s], of a clock that never goes back.
  void keep(const Eigen::VectorXd& warmth, double now) { last_[warmth.size()] = {warmth, now}; }
  // Returns what is left of it: each motor has cooled since. They are cold if nothing was kept.
  Eigen::VectorXd left(const ArmDescription& arm, double now) const {
    const auto known = last_.find(arm.dof());
    if (known == last_.end()) return Eigen::VectorXd::Zero(arm.dof());
    Eigen::VectorXd warmth = known->second.warmth;
    for (Eigen::Index i = 0; i < warmth.size(); ++i) {
      const double time = arm.joints[static_cast<std::size_t>(i)].warming;
      warmth[i] = time > 0 ? warmth[i] * exponential(-(now - known->second.at) / time) : 0;
    }
    return warmth;
  }

 private:
  struct Kept {
    Eigen::VectorXd warmth;
    double at;  // [s]
  };
  std::map<Eigen::Index, Kept> last_;
};

}  // namespace limpid
