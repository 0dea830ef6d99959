#include "app/run/tip_limits.h"

#include <fmt/format.h>

#include <numbers>

#include "app/run/analysis.h"

namespace limpid {
std::string still_tip(const ArmDescription& arm) {
  constexpr double kNoLever = 1e-9;  // round-off [m]
  if (arm_at(arm, rest_pose(arm)).J.norm() > kNoLever) return {};
  return fmt::format(
      "no joint moves the tip '{}' from the rest pose, so nothing can be felt at this tip; choose "
      "another link with --tip",
      arm.tip_link);
}

TipLimits tip_limits(const ArmDescription& description, const Eigen::VectorXd& x,
                     const Parameters& p, const Scene& scene) {
  const ArmAt arm = arm_at(description, x);
  const Eigen::VectorXd b_d = device_damping(description, p);
  const Vec3 n = least_damped(arm.J, b_d);

  TipLimits l;
  l.tip = tip_along(arm.J, arm.M, b_d, n);
  l.easiest = easiest(arm.J, arm.M);
  const Eigen::VectorXd weights = gain_weights(p, b_d);
  l.weight = weight_at_tip(arm.J, weights, n);
  l.easiest_weight = longest_levers_weight(arm.J, weights);
  l.loop = {p.tick,
            l.weight * p.k_vc,
            l.weight * p.b_v,
            p.eta,
            p.hand_damping,
            p.hand_mass_at_tip,
            device_delay(description, p)};
  l.link = static_cast<const LinkSettings&>(p);
  l.condition3 = condition3(description, p);
  l.encoder_step = p.encoder_step;
  l.friction = (1 - p.friction_share) * friction_at_tip(arm.J, device_friction(description, p));
  l.hand_stiffness = p.hand_stiffness;
  l.inertia_ratio = p.inertia_ratio;
  const double lever2 = l.tip.lever2;
  l.felt = {(1 + p.inertia_ratio) * l.tip.led,
            l.tip.damping,
            l.weight * p.b_v / lever2,
            l.weight * p.k_vc / lever2,
            l.weight * p.b_vc / lever2,
            p.tick,
            0,
            2 * p.oldest() * p.tick};
  l.w_f = p.alpha / lever2 / l.felt.m;
  l.delay_most = most_delay(p, description.delay, description.delay.has_value());
  l.added = added_mass(p.eta, l.delay_most, p.tick, p.inertia_ratio);

  for (std::size_t i = 0; i < kLaws; ++i) {
    l.walls[i] = wall_at_tip(static_cast<CouplingKind>(i), p, l);
  }
  l.every_hand = every_hands_wall(l.tip, p.tick, l.loop.delay);
  l.scene = stiffest_surface(scene);
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

std::string less_added_text(const TipLimits& l, const Parameters& p) {
  const bool late = l.added.edge < added_mass(p.eta, 0, p.tick, p.inertia_ratio).edge;
  const bool heavy = p.eta > InertiaShape::most_eta(p.inertia_ratio);
  if (p.eta <= 1 || (!late && !heavy)) return {};
  std::string why;
  if (late) why = fmt::format("the torque may be {:.3g} ms late", 1e3 * p.tick * l.delay_most);
  if (late && heavy) why += ", and ";
  if (heavy) why += fmt::format("the proxy has {:.2g} times the device's inertia", p.inertia_ratio);
  return fmt::format("{:.3g} up to {:.2g} Hz, because {}", l.added.eta,
                     l.added.edge / (2 * std::numbers::pi), why);
}

}  // namespace limpid
