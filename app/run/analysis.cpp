#include "app/run/analysis.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"

namespace limpid {

Eigen::VectorXd device_damping(const ArmDescription& arm, const Parameters& p) {
  Eigen::VectorXd b_d(static_cast<Eigen::Index>(arm.joints.size()));
  for (Eigen::Index i = 0; i < b_d.size(); ++i) {
    const Joint& joint = arm.joints[static_cast<std::size_t>(i)];
    b_d[i] = std::isnan(p.damping) ? joint.damping : p.damping;
  }
  return b_d;
}

ArmAt arm_at(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames frames;
  arm.frames(x, frames);
  Mat<kAnyDof> M;
  arm.inertia(frames, M);
  Jacobian<kAnyDof> J;
  arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
  return {M, J};
}

namespace {

// All but the grip.
Analysis of_modes(std::vector<LockedMode> modes, const Eigen::VectorXd& b_d, const Parameters& p,
                  std::optional<double> w_b) {
  Analysis a;
  a.b = b_d.minCoeff() + p.b_v;
  for (const LockedMode& mode : modes) {
    a.w_f.push_back(mode.w_f());
    a.w_c.push_back(mode.w_c());
    a.eta_min = std::max(a.eta_min, eta_min(mode));
    if (w_b) a.eta_min_band = std::max(a.eta_min_band.value_or(0), eta_min_band(mode, *w_b));
  }
  a.modes = std::move(modes);
  a.condition3 = condition3(p, p.tick, std::span(b_d.data(), static_cast<std::size_t>(b_d.size())));
  a.passive = p.eta >= a.eta_min;
  return a;
}

// The locked system at a configuration, in the hand.
struct Held {
  Eigen::MatrixXd M_L;       // [kg m^2]
  Eigen::VectorXd b;         // b_d + b_v of each joint [N m s/rad]
  Eigen::MatrixXd K_h, B_h;  // of the grip, at the joints [N m/rad, N m s/rad]
};

Held held_at(const ArmDescription& description, const Eigen::VectorXd& x, const Parameters& p) {
  const ArmAt arm = arm_at(description, x);
  const Eigen::MatrixXd JJ = arm.J.transpose() * arm.J;
  const Eigen::VectorXd b = device_damping(description, p).array() + p.b_v;
  return {(1 + p.inertia_ratio) * arm.M, b, p.hand_stiffness * JJ, p.hand_damping * JJ};
}

}  // namespace

Analysis analyze(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 std::optional<double> w_b) {
  const Held held = held_at(arm, x, p);
  Analysis a = of_modes(locked_modes(held.M_L, held.b, p.alpha), device_damping(arm, p), p, w_b);
  a.eta_min_grip = eta_min_grip(held.M_L, held.b, p.alpha, held.K_h, held.B_h);
  return a;
}

std::vector<std::complex<double>> handle_poles(const ArmDescription& arm, const Eigen::VectorXd& x,
                                               const Parameters& p) {
  const Held held = held_at(arm, x, p);
  const Eigen::VectorXcd poles = grip_poles(held.M_L, held.b, p.alpha, p.eta, held.K_h, held.B_h);
  return {poles.begin(), poles.end()};
}

Analysis analyze(double mass, const ArmDescription& arm, const Parameters& p,
                 std::optional<double> w_b) {
  const Eigen::VectorXd b_d = device_damping(arm, p);
  const LockedMode mode{mass, b_d.minCoeff() + p.b_v, p.alpha};
  Analysis a = of_modes({mode}, b_d, p, w_b);
  a.eta_min_grip = eta_min_grip(mode, p.hand_stiffness, p.hand_damping);
  return a;
}

}  // namespace limpid
