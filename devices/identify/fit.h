// Identification of a device from its motion: inertia, gravity, friction, springs and delay.
#pragma once

#include <vector>

#include "core/dynamics/regressor.h"
#include "devices/identify/motion_record.h"

namespace limpid {

// Number of a joint's own parameters, besides its link's: viscous, Coulomb, offset, spring.
inline constexpr Eigen::Index kOwnParameters = 4;

// Equations of motion of a record, tau = A z, a row for each time and joint that can be trusted.
// Such a joint moves on throughout the window: only there friction is as modelled. z: the
// parameters of all links in turn, then those of the joints.
struct Equations {
  Eigen::MatrixXd A;
  std::vector<Eigen::Index> time, joint;  // of each row

  // The torques of these rows; `torque` has a row for each time and a column for each joint.
  Eigen::VectorXd of(const Eigen::MatrixXd& torque) const;
};

// Times with independent noise, far enough inside the record [s]. Errors: std::invalid_argument if
// the record is too short for any.
Eigen::VectorXd independent_times(const MotionRecord& record, const Smoothing& window,
                                  double longest_delay);

// Equations of motion at `times`, which are as for motion_at(); `gravity` in the base's frame
// [m/s^2].
Equations equations_of(const ArmDescription& guess, const MotionRecord& record, const Vec3& gravity,
                       const Smoothing& window, const Eigen::VectorXd& times);

// Physically consistent inertial parameters of a link, near those of a guess.
//
// A body's second moments about its origin, Sigma = int r r^T dm = (tr I / 2) 1 - I, its first
// moment h = m c and its mass make the pseudo-inertia
//     J = [ Sigma  h ]
//         [ h^T    m ],
// which is positive definite for every body of some extent and for nothing else (Wensing, Kim and
// Slotine, 2017). With J = L0 E E^T L0^T, L0 the guess's and E a lower triangle with the diagonal
// e^d, every vector of ten numbers is a body, and the zero vector is the guess.
class PlausibleLink {
 public:
  // A guess without extent is given a little extent.
  explicit PlausibleLink(const LinkParameters& guess);

  LinkParameters at(const LinkParameters& d) const;
  // Derivative of at(), a column for each number.
  Eigen::Matrix<double, kLinkParameters, kLinkParameters> slope(const LinkParameters& d) const;

 private:
  Eigen::Matrix4d L0_;
};

// A found value and its standard deviation.
struct Found {
  double value = 0;
  double deviation = 0;
};

struct JointFinding {
  Found inertia;  // M_jj at the middle of the record [kg m^2]
  Found gravity;  // torque of the links' weight there [N m]
  Found viscous;  // [N m s/rad]
  Found coulomb;  // [N m]
  Found offset;   // constant torque of a spring's middle, or friction differing by direction [N m]
  Found spring;   // [N m/rad]
  double residual = 0;       // root mean square error of the torque [N m]
  double torque = 0;         // root mean square of the torque to explain [N m]
  Eigen::Index samples = 0;  // number of independent samples used
};

// Torque of a moving joint at one moment, and its parts in the model.
struct Explained {
  double time = 0;  // since the first row [s]
  Eigen::Index joint = 0;
  double velocity = 0;  // [rad/s]
  double torque = 0;    // of the motor [N m]
  double bodies = 0;    // part of it: inertia and weight of the links [N m]
  double springs = 0;   // part of it: the joint's spring and offset [N m]
  double friction = 0;  // part of it: Coulomb and viscous friction [N m]
};

struct Identified {
  ArmDescription arm;  // the guess with the found values, and the gravity of the settings
  std::vector<JointFinding> joints;
  Eigen::VectorXd middle;  // pose at which inertia and gravity are given [rad]
  Found delay;             // from a reading to the torque that answers it, beyond the tick [s]
  std::vector<Explained> moments{};
};

struct FitSettings {
  Vec3 gravity = Vec3::Zero();   // in the base's frame [m/s^2]; zero: none, or compensated
  double longest_delay = 0.012;  // [s]
};

// Fits the device's parameters to a record. The guess gives axes and lengths as they are, and
// masses that change only where the motion says so. Fits tau = Y(x, v, a) pi + viscous v + coulomb
// sign(v) + offset + spring x over windows. Torques are shifted by the delay that explains them
// best. Rows are weighted by their joint's noise, large misses less (Huber); the links' parameters
// stay plausible. Errors: std::invalid_argument for too little motion: every joint has to move, and
// needs at least 100 independent samples.
Identified identify(const ArmDescription& guess, const MotionRecord& record,
                    const FitSettings& settings);

}  // namespace limpid
