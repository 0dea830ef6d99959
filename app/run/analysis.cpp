#include "app/run/analysis.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"

namespace limpid {
namespace {

std::vector<double> device_damping(const ArmDescription& arm, const Parameters& p) {
  std::vector<double> b_d;
  for (const Joint& joint : arm.joints) {
    b_d.push_back(std::isnan(p.damping) ? joint.damping : p.damping);
  }
  return b_d;
}

// All but the grip.
Analysis of_modes(std::vector<LockedMode> modes, const std::vector<double>& b_d,
                  const Parameters& p, std::optional<double> w_b) {
  Analysis a;
  a.b = *std::ranges::min_element(b_d) + p.b_v;
  for (const LockedMode& mode : modes) {
    a.w_f.push_back(mode.w_f());
    a.w_c.push_back(mode.w_c());
    a.eta_min = std::max(a.eta_min, eta_min(mode));
    if (w_b) a.eta_min_band = std::max(a.eta_min_band.value_or(0), eta_min_band(mode, *w_b));
  }
  a.modes = std::move(modes);
  a.condition3 = condition3(p, b_d);
  a.passive = p.eta >= a.eta_min;
  return a;
}

}  // namespace

Analysis analyze(const ArmDescription& description, const Eigen::VectorXd& x, const Parameters& p,
                 std::optional<double> w_b) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames frames;
  arm.frames(x, frames);
  Mat<kAnyDof> M;
  arm.inertia(frames, M);
  const Eigen::MatrixXd M_L = (1 + p.inertia_ratio) * M;
  Jacobian<kAnyDof> J;
  arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
  const Eigen::MatrixXd JJ = J.transpose() * J;

  const std::vector<double> b_d = device_damping(description, p);
  Eigen::VectorXd b(arm.dof());
  for (int i = 0; i < arm.dof(); ++i) b[i] = b_d[static_cast<std::size_t>(i)] + p.b_v;
  Analysis a = of_modes(locked_modes(M_L, b, p.alpha), b_d, p, w_b);
  a.eta_min_grip = eta_min_grip(M_L, b, p.alpha, p.hand_stiffness * JJ, p.hand_damping * JJ);
  return a;
}

Analysis analyze(double mass, const ArmDescription& arm, const Parameters& p,
                 std::optional<double> w_b) {
  const std::vector<double> b_d = device_damping(arm, p);
  const LockedMode mode{mass, *std::ranges::min_element(b_d) + p.b_v, p.alpha};
  Analysis a = of_modes({mode}, b_d, p, w_b);
  a.eta_min_grip = eta_min_grip(mode, p.hand_stiffness, p.hand_damping);
  return a;
}

}  // namespace limpid
