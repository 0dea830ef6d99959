#include "app/run/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/arm.h"
#include "core/math/eigen.h"

namespace limpid {

namespace {

// Tells whether the grip is stable at eta, by
// x1' = v1;  x2' = (k_vc (x1 - x2) + b_vc v1) / (b_v + b_vc);  f_hat' = alpha M^-1 (f - f_hat);
// M v1' = f - b_d v1 - k_vc (x1 - x2) - b_vc (v1 - x2') + (1 - eta)/eta f_hat;
// f = -K_h x1 - B_h v1.
bool stable(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d, const Parameters& p,
            const Eigen::MatrixXd& K_h, const Eigen::MatrixXd& B_h, double eta) {
  const Eigen::Index n = M_L.rows();
  const Eigen::MatrixXd W = inverse(M_L), I = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd weights = gain_weights(p, b_d).asDiagonal();
  const double spring = p.k_vc / (p.b_v + p.b_vc), drag = p.b_vc / (p.b_v + p.b_vc);
  const double k = p.k_vc - p.b_vc * spring, b = p.b_vc - p.b_vc * drag;
  const Eigen::MatrixXd D = Eigen::MatrixXd(b_d.asDiagonal()) + B_h + b * weights;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4 * n, 4 * n);  // x1, v1, f_hat, x2
  A.block(0, n, n, n) = I;
  A.block(n, 0, n, n) = -W * (K_h + k * weights);
  A.block(n, n, n, n) = -W * D;
  A.block(n, 2 * n, n, n) = (1 - eta) / eta * W;
  A.block(n, 3 * n, n, n) = k * W * weights;
  A.block(2 * n, 0, n, n) = -p.alpha * W * K_h;
  A.block(2 * n, n, n, n) = -p.alpha * W * B_h;
  A.block(2 * n, 2 * n, n, n) = -p.alpha * W;
  A.block(3 * n, 0, n, n) = spring * I;
  A.block(3 * n, n, n, n) = drag * I;
  A.block(3 * n, 3 * n, n, n) = -spring * I;
  const Eigen::VectorXcd poles = eigenvalues(A);
  return poles.real().maxCoeff() < 1e-9 * poles.cwiseAbs().maxCoeff();
}

// Analyzes all but the grip.
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
  a.condition3 = condition3(arm, p);
  a.line_margin = b_d.minCoeff() - (p.wave_matched ? 3 : 2) * p.line();
  a.link = p.oldest() * p.tick;
  a.above_eta_min = p.eta >= a.eta_min;
  return a;
}

// Locked system at a configuration, in the hand.
struct Held {
  Eigen::MatrixXd M_L;       // [kg m^2]
  Eigen::VectorXd b;         // b_d + b_v of each joint [N m s/rad]
  Eigen::MatrixXd K_h, B_h;  // of the grip, at the joints [N m/rad, N m s/rad]
};

Held held_at(const ArmDescription& description, const Eigen::VectorXd& x, const Parameters& p) {
  const ArmAt arm = arm_at(description, x);
  const Eigen::MatrixXd JJ = arm.J.transpose() * arm.J;
  const Eigen::VectorXd b_d = device_damping(description, p),
                        b = b_d + p.b_v * gain_weights(p, b_d);
  return {(1 + p.inertia_ratio) * arm.M, b, p.hand_stiffness * JJ, p.hand_damping * JJ};
}

// Judges spring and damper alone.
Passivity by_condition3(const Condition3& c) {
  if (!c.known) return {std::nullopt, "no limit is known because packets are lost (link.loss)"};
  return {c.holds, c.holds ? "condition (3) is met" : "condition (3) is broken"};
}

Passivity of_feedforward(const Analysis& a, const Parameters& p) {
  if (!a.above_eta_min)
    return {false, fmt::format("eta is below eta_min {:.4f}, equation (25)", a.eta_min)};
  if (p.eta < a.eta_min_compliant) {
    return {false, fmt::format("eta is below {:.4f}: the coupling is unstable in this grip",
                               a.eta_min_compliant)};
  }
  Passivity spring = by_condition3(a.condition3);
  if (spring.passive == false) return spring;
  if (p.linked()) return {std::nullopt, "no limit is known for feedforward torques through a link"};
  if (a.delay > 0) {
    return {std::nullopt,
            fmt::format("no limit is known for feedforward torques that act {:.3g} ms late",
                        1e3 * a.delay)};
  }
  return {true,
          "in free motion: eta is at least eta_min, equation (25), and condition (3) of the paper "
          "is met"};
}

// A value of every joint: what is set, else the arm's own.
Eigen::VectorXd of_joints(const ArmDescription& arm, double Joint::*own, double set) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(arm.joints.size()));
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    all[i] = std::isnan(set) ? arm.joints[static_cast<std::size_t>(i)].*own : set;
  }
  return all;
}

}  // namespace

double eta_min_compliant(const Eigen::MatrixXd& M_L, const Eigen::VectorXd& b_d,
                         const Parameters& p, const Eigen::MatrixXd& K_h,
                         const Eigen::MatrixXd& B_h, double least) {
  double low = std::max(least, 1e-6), high = 1;
  if (stable(M_L, b_d, p, K_h, B_h, low)) return least;
  while (high - low > 1e-6) {
    const double middle = (low + high) / 2;
    (stable(M_L, b_d, p, K_h, B_h, middle) ? high : low) = middle;
  }
  return high;
}

Eigen::VectorXd device_damping(const ArmDescription& arm, const Parameters& p) {
  return of_joints(arm, &Joint::damping, p.damping);
}

Eigen::VectorXd device_friction(const ArmDescription& arm, const Parameters& p) {
  return of_joints(arm, &Joint::friction, p.friction);
}

Eigen::VectorXd coupling_springs(const ArmDescription& arm, const Parameters& p) {
  return springs(p, device_damping(arm, p));
}

double device_delay(const ArmDescription& arm, const Parameters& p) {
  const double known = arm.delay ? *arm.delay : p.delay * p.tick;
  // The virtual arm delays by whole ticks; the measured delay rounded to them counts as measured.
  const double simulated = p.device_delay * p.tick;
  return simulated > known + p.tick / 2 ? simulated : known;
}

std::vector<CouplingKind> laws_told(CouplingKind chosen, bool all) {
  std::vector<CouplingKind> told;
  for (std::uint8_t i = 0; i < kLaws; ++i) {
    const auto kind = static_cast<CouplingKind>(i);
    if (all || kind == chosen || !info(kind).for_comparison) told.push_back(kind);
  }
  return told;
}

Condition3 condition3(const ArmDescription& arm, const Parameters& p) {
  const Eigen::VectorXd b_d = device_damping(arm, p);
  return condition3(p, p.tick, std::span(b_d.data(), static_cast<std::size_t>(b_d.size())),
                    device_delay(arm, p), p);
}

std::string basis_text(const ArmDescription& arm, const Parameters& p) {
  const std::string delay = fmt::format("a delay of {:.1f} ms", 1e3 * device_delay(arm, p));
  const bool set = !std::isnan(p.damping);
  if (arm.delay) {
    return set ? fmt::format("inertia and {}, measured; damping as in the settings", delay)
               : fmt::format("inertia, damping and {}, measured", delay);
  }
  return fmt::format(
      "{}, {}",
      set ? "inertia as in the arm's file, damping as in the settings"
          : "inertia and damping as in the arm's file",
      p.delay + p.device_delay > 0 ? delay + " as in the settings" : "no delay (assumed)");
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

Analysis analyze(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 std::optional<double> w_b) {
  const Held held = held_at(arm, x, p);
  Analysis a = of_modes(locked_modes(held.M_L, held.b, p.alpha), arm, p, w_b);
  a.eta_min_grip = eta_min_grip(held.M_L, held.b, p.alpha, held.K_h, held.B_h);
  a.eta_min_compliant =
      eta_min_compliant(held.M_L, device_damping(arm, p), p, held.K_h, held.B_h, a.eta_min_grip);
  return a;
}

Passivity passivity(const Analysis& a, const Parameters& p) {
  switch (info(p.kind).promise) {
    case Promise::condition3: return by_condition3(a.condition3);
    case Promise::eta_min: return of_feedforward(a, p);
    case Promise::ledger:
      if (p.tick > kTriedTick) {
        return {
            std::nullopt,
            "no limit is known: the law's energy account was tested only at ticks of up to 1 ms"};
      }
      return {true, fmt::format("the energy account: the hand is given at most {:.3g} mJ",
                                1e3 * p.energy)};
    case Promise::tanks:
      return {true, fmt::format("the energy tanks: the hand is given at most {:.3g} mJ",
                                1e3 * p.tank_energy)};
    case Promise::port:
      return {true,
              "the energy account: the hand is given no energy if the value of the device's "
              "damping is right"};
    case Promise::line:
      if (a.line_margin >= 0) {
        return {true, "the wave line's impedance is small compared with the device's damping"};
      }
      return {
          std::nullopt,
          "no limit is known: the wave line's impedance is above a third of the device's damping"};
    case Promise::observer:
      return {std::nullopt,
              "no limit is known: the law's damper may be too small or may act too late"};
    case Promise::none:
      return {std::nullopt, "no limit is known: passivity depends on the hand's damping"};
  }
  return {};
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
  const auto scalar = [](double x) { return Eigen::MatrixXd::Constant(1, 1, x); };
  a.eta_min_compliant = eta_min_compliant(
      scalar(mass), Eigen::VectorXd::Constant(1, device_damping(arm, p).minCoeff()), p,
      scalar(p.hand_stiffness), scalar(p.hand_damping), a.eta_min_grip);
  return a;
}

}  // namespace limpid
