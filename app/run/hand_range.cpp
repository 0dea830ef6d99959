#include "app/run/hand_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/run/sampled_wall.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kEvery = std::numeric_limits<double>::infinity();

// Hands of a range, evenly in the logarithm, with both ends.
std::vector<double> hands_of(const HandRange& range) {
  constexpr int kHands = 6;
  std::vector<double> hands;
  const double low = std::max(range.from, 1.0), high = std::max(range.to, 1.0);
  for (int i = 1; i < kHands; ++i) {
    hands.push_back(low * power(high / low, static_cast<double>(i) / kHands));
  }
  hands.insert(hands.begin(), range.from);
  hands.push_back(range.to);
  return hands;
}

// Whole ticks that are at least as late as `delay` [s].
int ticks_of(double delay, double T) { return static_cast<int>(std::ceil(delay / T - 1e-6)); }

class JudgedLaws {
 public:
  JudgedLaws(const ArmDescription& arm, const ArmAt& at, const Parameters& p, const Analysis& a,
             const TipLimits& tip, const HandRange& range)
      : arm_(arm), at_(at), p_(p), a_(a), tip_(tip), hands_(hands_of(range)) {}

  LawInHands judge(CouplingKind kind, const InHands& all) const {
    Parameters p = p_;
    p.kind = kind;
    LawInHands law;
    law.in_any_hand = info(kind).loop == LinearLoop::on_device ? on_device(all) : passive_walls(p);
    const bool every = law.in_any_hand.up_to == kEvery;
    law.in_range = every ? SafeWalls{kEvery, std::nullopt, "the same as in every passive hand"}
                         : in_range(kind);
    law.two_port_why = unknown_two_port(kind);
    if (law.two_port_why.empty()) criterion(kind, law);
    return law;
  }

 private:
  SafeWalls passive_walls(const Parameters& p) const {
    const Passivity known = passivity(a_, p);
    if (known.passive == false) return {0, std::nullopt, known.by};
    if (!known.passive) return {std::nullopt, std::nullopt, known.by};
    // The conditions of (25) are about free motion and the spring.
    if (info(p.kind).promise == Promise::eta_min) {
      return {std::nullopt, std::nullopt,
              "passive in free motion; no limit is known for contact forces, because they are fed "
              "forward with a delay"};
    }
    return {kEvery, std::nullopt, known.by};
  }
  SafeWalls on_device(const InHands& all) const {
    if (p_.encoder_step > 0 && !all.stepped.wall) {
      return {std::nullopt, std::nullopt,
              "no limit is known for encoder steps together with a delay"};
    }
    const double stepped = all.stepped.wall.value_or(kEvery), sampled = *all.sampled.wall;
    return {std::min(sampled, stepped), std::nullopt,
            (stepped < sampled ? all.stepped : all.sampled).name};
  }
  // The hand of the range in which the softest wall is unstable.
  SafeWalls in_range(CouplingKind kind) const {
    const LinearLoop loop = info(kind).loop;
    const auto unknown = [](const char* why) { return SafeWalls{std::nullopt, std::nullopt, why}; };
    if (loop == LinearLoop::none) return unknown("no limit is known: the law is not linear");
    if (loop != LinearLoop::on_device && p_.linked()) {
      return unknown("no limit is computed for a law with a link between device and proxy");
    }
    if (loop == LinearLoop::fed_forward && p_.velocity != VelocitySource::raw) {
      return unknown(
          "a limit is computed only with unfiltered velocities (observer.velocity = raw)");
    }
    SafeWalls found{kEvery, std::nullopt,
                    "the sampled loop of arm, hand and wall, with exact encoders"};
    const Eigen::VectorXd b_d = device_damping(arm_, p_);
    const Eigen::MatrixXd JJ = at_.J.transpose() * at_.J;
    const Eigen::VectorXd lever = at_.J.transpose() * least_damped(at_.J, b_d);
    const Eigen::MatrixXd across = lever * lever.transpose(), M2 = p_.inertia_ratio * at_.M;
    const FedForward forward{p_.eta, p_.alpha,
                             p_.inertia_ratio / (p_.inertia_error + p_.inertia_ratio),
                             p_.inertia_error * at_.M, b_d};
    for (const double hand : hands_) {
      const HeldArm held{at_.M + p_.hand_mass_at_tip * JJ,
                         Eigen::MatrixXd(b_d.asDiagonal()) + p_.hand_damping * JJ,
                         hand * JJ,
                         p_.tick,
                         ticks_of(tip_.loop.delay, p_.tick),
                         gain_weights(p_, b_d)};
      const double wall = stable_up_to([&](double K) {
        switch (loop) {
          case LinearLoop::on_device: return growth_on_device(held, K * across);
          case LinearLoop::fed_forward:
            return growth_fed_forward(held, p_, forward, M2, K * across);
          default: return growth_behind_spring(held, p_, M2, K * across);
        }
      });
      if (wall < *found.up_to) {
        found.up_to = wall;
        found.hand = hand;
      }
    }
    return found;
  }
  std::string unknown_two_port(CouplingKind kind) const {
    switch (info(kind).loop) {
      case LinearLoop::on_device: return {};
      case LinearLoop::behind_spring:
        if (p_.link_jitter > 0 || p_.link_loss > 0) {
          return "not known: the criterion needs a link with a constant delay";
        }
        return {};
      case LinearLoop::fed_forward:
        return "not known: the law feeds forces forward; equation (25) applies to this law";
      case LinearLoop::none: break;
    }
    return "not known: the law is not linear";
  }
  void criterion(CouplingKind kind, LawInHands& law) const {
    const bool on_device = info(kind).loop == LinearLoop::on_device;
    const Eigen::VectorXd b_d = device_damping(arm_, p_);
    const SampledJoint joint{b_d.minCoeff(), p_.tick, ticks_of(tip_.loop.delay, p_.tick),
                             p_.link_delay};
    law.two_port = llewellyn(
        [&](double f) {
          return on_device ? device_two_port(joint, f) : spring_two_port(p_, joint, f);
        },
        p_.tick);
    law.two_port_why =
        !law.two_port->fails_from ? "every passive hand is stable on every passive contact"
        : on_device
            ? "without a spring between hand and wall, some walls are unstable in some hands"
            : "some contacts are unstable in some hands";
  }

  const ArmDescription& arm_;
  const ArmAt& at_;
  const Parameters& p_;
  const Analysis& a_;
  const TipLimits& tip_;
  std::vector<double> hands_;
};

NamedBound colgate_schenkel(const TipLimits& tip) {
  return {"Colgate and Schenkel", "Colgate and Schenkel 1997, J. Robotic Systems 14, 37",
          "K <= b_d/(T/2 + delay); b_d is the arm's damping at the tip", tip.every_hand};
}

NamedBound abbott_okamura(const ArmDescription& arm, const ArmAt& at, const Parameters& p,
                          const TipLimits& tip) {
  NamedBound bound{
      "Abbott and Okamura", "Abbott and Okamura 2005, IEEE Trans. Robotics 21, 952",
      "K <= min(2 b_d/T, 2 f_c/q); f_c is the friction and q the encoder step at the tip",
      std::nullopt};
  if (tip.loop.delay > 0) {
    bound.rule += "; this bound is known only if there is no delay";
    return bound;
  }
  const double friction = (1 - p.friction_share) * friction_at_tip(at.J, device_friction(arm, p));
  const double q = p.encoder_step * std::sqrt(tip.tip.lever2);
  bound.wall = std::min(2 * tip.tip.damping / p.tick, q > 0 ? 2 * friction / q : kEvery);
  return bound;
}

// The largest of the smallest stable eta in hands of the range.
double eta_min_in(const ArmDescription& arm, const Eigen::VectorXd& x, Parameters p,
                  const HandRange& range) {
  double most = 0;
  for (const double hand : hands_of(range)) {
    p.hand_stiffness = hand;
    most = std::max(most, analyze(arm, x, p, std::nullopt).eta_min_compliant);
  }
  return most;
}

}  // namespace

InHands in_hands(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p,
                 const Analysis& a, const TipLimits& tip, const HandRange& range) {
  const ArmAt at = arm_at(arm, x);
  InHands all{range,
              p.hand_damping,
              p.hand_mass_at_tip,
              colgate_schenkel(tip),
              abbott_okamura(arm, at, p, tip),
              eta_min_in(arm, x, p, range),
              a.eta_min,
              {}};
  const JudgedLaws laws(arm, at, p, a, tip, range);
  for (std::size_t i = 0; i < kLaws; ++i) {
    all.laws[i] = laws.judge(static_cast<CouplingKind>(i), all);
  }
  return all;
}

}  // namespace limpid
