#include "app/run/tip_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/run/analysis.h"

namespace limpid {
namespace {

// Friction at the tip of a Touch, as an example for arms without any [N].
constexpr double kUsualFriction = 0.26;

TipLimits::Wall predictive_wall(const TipMoved& tip, const WallSetting& s, double friction,
                                const Parameters& p) {
  PredictiveWallSetting setting{s,           p.encoder_step,   friction,
                                p.hand_mass, p.delay * p.tick, p.inertia_ratio};
  const BoundedWall wall = predictive_wall(tip, setting);
  const double q_t = 1000 * p.encoder_step * tip.lever;  // [mm]
  const auto why = [&]() -> std::string {
    switch (wall.by) {
      case WallBound::tried:
        return fmt::format("the stiffest wall that was tried{}{}",
                           p.encoder_step > 0 ? " with encoder steps" : "",
                           p.tick > 1.001e-3 ? " at so long a tick" : "");
      case WallBound::quick:
        return fmt::format("the tip's {:.2g} g move far in a tick, and the hand is not known",
                           1000 * tip.mass);
      case WallBound::proxy: return "the proxy's inertia is felt through k_vc from there on";
      case WallBound::step:
        return fmt::format("step: one of {:.2g} mm of the encoder at the tip pushes with 0.25 N",
                           q_t);
      case WallBound::friction:
        return fmt::format("friction: {:.2g} N at the tip still hold it inside a cell of {:.2g} mm",
                           friction, q_t);
      case WallBound::cell:
        setting.friction = kUsualFriction;
        return fmt::format(
            "cell: the tip swings within {:.2g} mm, unseen; with {} N of friction {:.0f} N/m", q_t,
            kUsualFriction, predictive_wall(tip, setting).stiffness);
      case WallBound::hand: return "a hand that is heavier than the predictor takes it for";
      case WallBound::delay: break;
    }
    const bool known = std::abs(s.delay - p.delay * p.tick) <= p.tick / 2 * (1 + 1e-9);
    return fmt::format("a delay of {:.1f} ms{}", 1e3 * s.delay,
                       known ? "" : "; it is not reckoned with (model.delay)");
  };
  return {wall.stiffness, why()};
}

}  // namespace

std::string still_tip(const ArmDescription& arm) {
  constexpr double kNoLever = 1e-9;  // round-off [m]
  if (arm_at(arm, rest_pose(arm)).J.norm() > kNoLever) return {};
  return fmt::format(
      "no joint moves '{}', the tip, from the rest pose: there is no wall to name and nothing is "
      "felt there; --tip takes another link",
      arm.tip_link);
}

TipLimits tip_limits(const ArmDescription& description, const Eigen::VectorXd& x,
                     const Parameters& p, const Scene& scene) {
  const ArmAt arm = arm_at(description, x);
  const Eigen::VectorXd b_d = device_damping(description, p);
  const Vec3 n = least_damped(arm.J, b_d);

  TipLimits l;
  l.delay = device_delay(description, p);
  l.tip = tip_along(arm.J, arm.M, b_d, n);
  const double lever2 = l.tip.lever2;
  const WallSetting s{p.tick, p.k_vc, p.b_v, p.eta, p.hand_damping, p.hand_mass_at_tip, l.delay};
  WallSetting through_link = s;
  through_link.delay += 2 * p.oldest() * p.tick;
  const double friction =
      (1 - p.friction_share) * friction_at_tip(arm.J, device_friction(description, p));
  const Condition3 c = condition3(description, p);
  const double stepped = stepped_wall(p.encoder_step * std::sqrt(lever2), friction);
  const auto on_device = [&](double stiffness, const char* bound) -> TipLimits::Wall {
    if (stepped < stiffness) return {stepped, "a step of the encoder pushes the hand"};
    return {stiffness, bound};
  };
  const auto wall = [&](CouplingKind kind) -> TipLimits::Wall {
    switch (kind) {
      case CouplingKind::standard:
        if (!c.known) return {0, "no bound is known, as packets are lost (link.loss)"};
        if (!c.holds) {
          return {0, "condition (3) is broken: it is not passive in free motion either"};
        }
        [[fallthrough]];
      case CouplingKind::tank:
        return {spring_at_tip(l.tip, p.k_vc), "felt through the spring k_vc"};
      case CouplingKind::proposed:
        return {proposed_wall(l.tip, through_link),
                "the damping there is against the lag of the contact"};
      case CouplingKind::predictive: return predictive_wall(easiest(arm.J, arm.M), s, friction, p);
      case CouplingKind::wave:
        return {line_at_tip(l.tip, p.k_vc, p.line(), (p.oldest() + 0.5) * p.tick),
                "felt through the spring k_vc and the line: 1/(1/k_vc + (link + T/2)/b)"};
      case CouplingKind::tdpn:
        return {spring_at_tip(l.tip, p.k_vc),
                p.linked() ? "felt through the spring k_vc; falls with the link's delay"
                           : "felt through the spring k_vc"};
      case CouplingKind::direct:
        return on_device(direct_wall(l.tip, s),
                         "the damping of arm and hand: (b_d + b_h)/(T/2 + "
                         "delay)");
      case CouplingKind::eba:
        return {bounded_wall(l.tip, s), "the arm's damping: 2 b_d/(T + delay)"};
      case CouplingKind::popc:
        return on_device(braked_wall(l.tip, s, p.popc_damping),
                         "the damping of arm and hand, and its own damper, held for a tick");
      case CouplingKind::sfa: {
        const double soft = p.sfa_soft * every_hands_wall(l.tip, p.tick, l.delay);
        return {soft,
                fmt::format("its soft spring; in this grip, at rest, an increment leaves {:.2g} of "
                            "what a rigid wall lacks",
                            1 - p.sfa_step * soft / (soft + p.hand_stiffness))};
      }
    }
    return {};
  };
  for (std::size_t i = 0; i < kLaws; ++i) l.walls[i] = wall(static_cast<CouplingKind>(i));
  l.every_hand = every_hands_wall(l.tip, p.tick, l.delay);
  l.scene = stiffest_surface(scene);
  l.felt = {(1 + p.inertia_ratio) * l.tip.mass,
            l.tip.damping,
            p.b_v / lever2,
            p.k_vc / lever2,
            p.b_vc / lever2,
            p.tick,
            0,
            2 * p.oldest() * p.tick};
  l.w_f = p.alpha / lever2 / l.felt.m;
  l.delay_most = most_delay(p, description.delay, description.delay.has_value());
  l.added = added_mass(p.eta, l.delay_most, p.tick);
  return l;
}

TipLimits without_delay(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                        const Scene& scene) {
  ArmDescription prompt = arm;
  prompt.delay = 0;
  Parameters q = p;
  q.delay = q.device_delay = 0;
  return tip_limits(prompt, x, q, scene);
}

std::string late_text(const TipLimits& l, const Parameters& p) {
  if (p.eta <= 1 || l.added.edge >= added_mass(p.eta, 0, p.tick).edge) return {};
  return fmt::format("{:.3g} up to {:.2g} Hz, as the torque may be {:.3g} ms late", l.added.eta,
                     l.added.edge / (2 * std::numbers::pi), 1e3 * p.tick * l.delay_most);
}

FeltAtTip felt_at_tip(const TipLimits& l, const Parameters& p, CouplingKind kind, double f) {
  std::complex<double> Z;
  switch (kind) {
    case CouplingKind::standard:
    case CouplingKind::tank:
    case CouplingKind::tdpn: Z = l.felt.standard(f); break;
    case CouplingKind::wave: {
      // The line adds a mass where it is not matched, and its own damper.
      const double line = p.line() / l.tip.lever2;
      const double mass = p.oldest() * p.tick * (line - l.felt.b_v * l.felt.b_v / line);
      return {l.tip.mass + mass, l.tip.damping + l.felt.b_v + (p.wave_matched ? line : 0)};
    }
    case CouplingKind::proposed: Z = l.felt.proposed(f, p.eta, l.w_f); break;
    case CouplingKind::predictive:
      Z = l.felt.predictive(f, l.added, p.damping_share(p.eta), p.band,
                            {l.delay, std::max(0.0, l.delay - p.delay * p.tick)});
      break;
    case CouplingKind::direct:
    case CouplingKind::eba:
    case CouplingKind::popc:
    case CouplingKind::sfa: return {l.tip.mass, l.tip.damping};  // the arm alone
  }
  return {Z.imag() / (2 * std::numbers::pi * f), Z.real()};
}

}  // namespace limpid
