// The equations of motion that a record gives, for what is unknown in them.
#pragma once

#include <vector>

#include "core/dynamics/regressor.h"
#include "devices/identify/motion_record.h"

namespace limpid {

// Of a joint besides its link's: viscous, Coulomb, offset, spring.
inline constexpr Eigen::Index kOwnParameters = 4;

// tau = A z, a row for each time and joint that can be trusted: a joint that moves on throughout
// the window, as friction is what it is taken for only there. z: the links' parameters one after
// another, then the joints' own.
struct Equations {
  Eigen::MatrixXd A;
  std::vector<Eigen::Index> time, joint;  // of each row

  // The torques of these rows; `torque`: a row for each time, a column for each joint.
  Eigen::VectorXd of(const Eigen::MatrixXd& torque) const;
};

// Moments at which noise is independent, far enough within the record [s]. Errors:
// std::invalid_argument where it is too short for any.
Eigen::VectorXd independent_times(const MotionRecord& record, const Smoothing& window,
                                  double longest_delay);

// `times` as in motion_at(); `gravity` in the base's frame [m/s^2].
Equations equations_of(const ArmDescription& guess, const MotionRecord& record, const Vec3& gravity,
                       const Smoothing& window, const Eigen::VectorXd& times);

}  // namespace limpid
