// Theory of walls through a delay between device and proxy, at the table of the taps.
#pragma once

#include <Eigen/Core>

#include "app/experiments/experiment_arm.h"
#include "app/run/analysis.h"
#include "core/coupling/walls.h"
#include "core/tick/parameters.h"

namespace limpid {

class LinkTheory {
 public:
  // `grip`: stiffness of the hand [N/m]; its damping is that of the taps.
  LinkTheory(const ExperimentArm& on, double grip);

  // Return the stiffest wall on which a tap comes to rest at this delay and at every shorter one,
  // from kSoftest to kStiffest [N/m]. `delay`: each way [ticks].
  double standard(int delay) const;
  // The proposed law's spring is the standard coupling's, its contact late by the whole trip.
  double proposed(int delay) const;

 private:
  bool stable(double wall, int delay) const;
  double stiffest_up_to(double unstable, int delay) const;  // [N/m]

  double grip_;
  Parameters p_;
  TipAlong tip_;
  ArmAt at_;
  Eigen::Vector3d b_d_;
};

}  // namespace limpid
