// The smallest stable eta in a grip where the proxy is held by the coupling's spring, not rigidly.
#pragma once

#include "core/math/sizes.h"
#include "core/tick/parameters.h"

namespace limpid {

// As eta_min_grip of core/passivity/eta_min.h, with the shape system of (22): the proxy's damper
// b_v is felt through k_vc and b_vc of `p`, so above k_vc / b_v [rad/s] no more. The proxy weighs
// nothing. M_L inertia [kg m^2], b_d the device's damping of each joint [N m s/rad], K_h the grip's
// stiffness in joint space [N m/rad]; alpha of `p` [N m s/rad]. Found by bisection to 1e-6; 1 if
// none below is stable.
double eta_min_compliant(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d,
                         const Parameters& p, const Eigen::MatrixXd& K_h);

}  // namespace limpid
