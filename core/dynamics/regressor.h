// The torques of a chain as a linear function of its links' inertial parameters.
#pragma once

#include "core/dynamics/arm.h"

namespace limpid {

// Inertial parameters of one link, about its own frame's origin and in its axes:
//     m, m c_x, m c_y, m c_z, I_xx, I_xy, I_xz, I_yy, I_yz, I_zz   [kg, kg m, kg m^2].
inline constexpr Eigen::Index kLinkParameters = 10;
using LinkParameters = Eigen::Matrix<double, kLinkParameters, 1>;

LinkParameters parameters_of(const Link& link);
// Parameters of all links, one after another.
Eigen::VectorXd parameters_of(const ArmDescription& arm);
// Sets the link's mass, centre and inertia; the mass must be above 0.
void set_parameters(Link& link, const LinkParameters& parameters);

// Returns Y (n x 10 n) with Y pi = M(x) a + C(x, v) v + g(x), pi the links' parameters one after
// another. x, v, a: [rad, rad/s, rad/s^2]; gravity: in the base's frame [m/s^2].
Eigen::MatrixXd regressor(const Arm<kAnyDof>& arm, const Vec<kAnyDof>& x, const Vec<kAnyDof>& v,
                          const Vec<kAnyDof>& a, const Vec3& gravity);

}  // namespace limpid
