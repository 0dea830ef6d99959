#include "app/run/analysis.h"

#include <fmt/format.h>

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

double device_delay(const ArmDescription& arm, const Parameters& p) {
  const double known = arm.delay ? *arm.delay : p.delay * p.tick;
  // The virtual arm has whole ticks: rounded they are the measured one.
  const double simulated = p.device_delay * p.tick;
  return simulated > known + p.tick / 2 ? simulated : known;
}

std::string basis_text(const ArmDescription& arm, const Parameters& p) {
  const std::string delay = fmt::format("a delay of {:.1f} ms", 1e3 * device_delay(arm, p));
  const char* const b_d = std::isnan(p.damping) ? "damping" : "damping as set";
  if (arm.delay) return fmt::format("inertia, {} and {}, measured", b_d, delay);
  return fmt::format("inertia and {} as its file has them, {}", b_d,
                     p.delay + p.device_delay > 0 ? delay + " as set" : "no delay: assumed");
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
Analysis of_modes(std::vector<LockedMode> modes, const ArmDescription& arm, const Parameters& p,
                  std::optional<double> w_b) {
  const Eigen::VectorXd b_d = device_damping(arm, p);
  Analysis a;
  a.b = b_d.minCoeff() + p.b_v;
  for (const LockedMode& mode : modes) {
    a.w_f.push_back(mode.w_f());
    a.w_c.push_back(mode.w_c());
    a.eta_min = std::max(a.eta_min, eta_min(mode));
    if (w_b) a.eta_min_band = std::max(a.eta_min_band.value_or(0), eta_min_band(mode, *w_b));
  }
  a.modes = std::move(modes);
  a.delay = device_delay(arm, p);
  a.measured = arm.delay.has_value() && std::isnan(p.damping);
  a.condition3 =
      condition3(p, p.tick, std::span(b_d.data(), static_cast<std::size_t>(b_d.size())), a.delay);
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
  Analysis a = of_modes(locked_modes(held.M_L, held.b, p.alpha), arm, p, w_b);
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
  const LockedMode mode{mass, device_damping(arm, p).minCoeff() + p.b_v, p.alpha};
  Analysis a = of_modes({mode}, arm, p, w_b);
  a.eta_min_grip = eta_min_grip(mode, p.hand_stiffness, p.hand_damping);
  return a;
}

}  // namespace limpid
