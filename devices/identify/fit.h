// What a device is, from how it moved: inertia, gravity, friction, springs and delay.
#pragma once

#include <vector>

#include "core/dynamics/regressor.h"
#include "devices/identify/motion_record.h"

namespace limpid {

// The equations of motion that a record gives, for what is unknown in them.

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

// Inertial parameters of links that some body has, near those of a guess.
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
  // A guess without extent is given a little.
  explicit PlausibleLink(const LinkParameters& guess);

  LinkParameters at(const LinkParameters& d) const;
  // Its derivative, a column for each number.
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
  Found offset;   // torque that is always there: of a spring's middle, or friction that differs
                  // by direction [N m]
  Found spring;   // [N m/rad]
  double residual = 0;       // of the torque, root mean square [N m]
  double torque = 0;         // root mean square of what was there to explain [N m]
  Eigen::Index samples = 0;  // independent ones that were used
};

// What there was to explain of a joint that moved on, at some moment.
struct Explained {
  double time = 0;  // since the first row [s]
  Eigen::Index joint = 0;
  double velocity = 0;  // [rad/s]
  double torque = 0;    // of the motor [N m]
  double bodies = 0;    // of it, for inertia and weight of the links [N m]
  double springs = 0;   // of it, for the joint's spring and offset [N m]
  double friction = 0;  // of it, Coulomb and viscous [N m]
};

struct Identified {
  ArmDescription arm;  // the guess with what was found in it, gravity as it was said to be
  std::vector<JointFinding> joints;
  Eigen::VectorXd middle;  // where inertia and gravity are given [rad]
  Found delay;             // from a reading to the torque that answers it, beyond the tick [s]
  std::vector<Explained> moments{};
};

struct FitSettings {
  Vec3 gravity = Vec3::Zero();   // in the base's frame; zero: there is none, or it is compensated
  double longest_delay = 0.012;  // [s]
};

// The chain is the guess's: its axes and lengths are taken as they are, its masses as a start that
// is only left where the motion says so. tau = Y(x, v, a) pi + viscous v + coulomb sign(v) + offset
// + spring x, over windows, torques shifted by the delay that explains them best; weighted by each
// joint's noise, large misses for less (Huber), the links' parameters plausible throughout.
// Errors: std::invalid_argument for too little motion: no joint may be nearly at rest, and each
// needs at least 100 independent samples.
Identified identify(const ArmDescription& guess, const MotionRecord& record,
                    const FitSettings& settings);

}  // namespace limpid
