// Warmth of the motors of devices in the arm's place, from one loop to the next.
#pragma once

#include <map>
#include <mutex>

#include "core/dynamics/arm_description.h"
#include "core/math/elementary.h"

namespace limpid {

// Keeps it by the number of joints: a device that comes in another's place counts as warm as that
// one, so nothing is forgotten, whatever a device calls itself. For any thread but the haptic one.
class WarmthMemory {
 public:
  // Keeps the warmth that a loop ends with. `now` [s], of a clock that never goes back.
  void keep(const Eigen::VectorXd& warmth, double now) {
    const std::lock_guard lock(mutex_);
    of_loops_[warmth.size()] = {warmth, now};
  }
  // Adds what a motion beside the loops has warmed cold motors up by. Warmth is linear in the
  // square of the torque, so the next loop begins with the sum.
  void add(const Eigen::VectorXd& warmth, double now) {
    if (!(warmth.array() > 0).any()) return;  // an arm without a model
    const std::lock_guard lock(mutex_);
    Kept& kept = beside_loops_.try_emplace(warmth.size(), Kept{0 * warmth, now}).first->second;
    kept = {kept.warmth + warmth, now};
  }
  // Whether something was added that no loop has taken.
  bool added(Eigen::Index joints) const {
    const std::lock_guard lock(mutex_);
    return beside_loops_.contains(joints);
  }
  // Takes what is left of all of it for a loop that begins: each motor has cooled since. They are
  // cold if nothing was kept.
  Eigen::VectorXd take(const ArmDescription& arm, double now) {
    const std::lock_guard lock(mutex_);
    Eigen::VectorXd warmth = left(of_loops_, arm, now) + left(beside_loops_, arm, now);
    beside_loops_.erase(arm.dof());
    of_loops_[arm.dof()] = {warmth, now};
    return warmth;
  }

 private:
  struct Kept {
    Eigen::VectorXd warmth;
    double at;  // [s]
  };
  using ByJoints = std::map<Eigen::Index, Kept>;

  static Eigen::VectorXd left(const ByJoints& of, const ArmDescription& arm, double now) {
    const auto known = of.find(arm.dof());
    if (known == of.end()) return Eigen::VectorXd::Zero(arm.dof());
    Eigen::VectorXd warmth = known->second.warmth;
    for (Eigen::Index i = 0; i < warmth.size(); ++i) {
      const double time = arm.joints[static_cast<std::size_t>(i)].warming;
      warmth[i] = time > 0 ? warmth[i] * exponential(-(now - known->second.at) / time) : 0;
    }
    return warmth;
  }

  mutable std::mutex mutex_;
  ByJoints of_loops_, beside_loops_;
};

}  // namespace limpid
