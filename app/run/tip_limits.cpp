#include "app/run/tip_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "app/run/analysis.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

// Where the predictive coupling was found to end, with the built-in arm (experiment zwidth): walls
// up to 20,000 N/m were tried at 1 ms, at 2 ms they end at 3,500; a step of the encoder may change
// the wall's force by so much, and be so much of a speed; hands heavier than expected leave half of
// what theory does; delays.
constexpr double kTried = 20000, kTriedTick = 0.001;    // [N/m], [s]
constexpr double kFineStep = 0.11, kCoarseStep = 0.22;  // [N]
constexpr double kFineSpeed = 0.3, kSoftest = 100;      // [rad/s], [N/m]
constexpr double kCoarseWall = 2000;                    // [N/m]
// With a delay, by its milliseconds: one that it reckons with, the same with steps of 1e-4 rad, and
// one that it does not reckon with.
constexpr double kDelayedStep = 1e-4;  // [rad]
constexpr std::array kKnown{kTried, 3500.0, 1000.0, 270.0};
constexpr std::array kKnownStepped{kTried, 2300.0};
constexpr std::array kUnknown{kTried, 3500.0, 1400.0, 620.0, 290.0, 240.0, 190.0};

double delayed(std::span<const double> walls, double delay) {
  const auto i = static_cast<std::size_t>(std::lround(1000 * delay));
  return i < walls.size() ? walls[i] : kSoftest;
}

TipLimits::Wall predictive_wall(const TipLimits& l, const WallSetting& s, const Parameters& p) {
  TipLimits::Wall wall{kTried * std::min(1.0, power(kTriedTick / p.tick, 2.5)),
                       "the stiffest wall that was tried"};
  const auto bound = [&](double stiffness, std::string by) {
    if (stiffness < wall.stiffness) wall = {stiffness, std::move(by)};
  };
  const double q = p.encoder_step;
  if (q > 0) {
    const bool coarse = q > PredictorSettings::kCoarse;
    const double at_tip = q * std::sqrt(l.tip.lever2);
    bound(coarse ? std::min(kCoarseWall, kCoarseStep / at_tip) : kFineStep / at_tip,
          fmt::format("the encoder's step of {:.2g} rad, as measured with the built-in arm", q));
  }
  if (q <= PredictorSettings::kCoarse && q > kFineSpeed * p.tick) {
    bound(kSoftest, "the encoder's step, too coarse for so short a tick: see predictor.preset");
  }
  if (p.hand_mass_at_tip > p.hand_mass) {
    bound(mistaken_wall(l.tip, s) / 2, "a hand that is heavier than the predictor takes it for");
  }
  const bool known = std::abs(l.delay - p.delay * p.tick) <= p.tick / 2 * (1 + 1e-9);
  const std::span<const double> walls = !known              ? std::span<const double>(kUnknown)
                                        : q >= kDelayedStep ? std::span<const double>(kKnownStepped)
                                                            : std::span<const double>(kKnown);
  bound(delayed(walls, known ? l.delay : std::abs(l.delay - p.delay * p.tick)),
        fmt::format("a delay of {:.1f} ms, as measured with the built-in arm{}", 1e3 * l.delay,
                    known ? "" : "; it is not reckoned with (model.delay)"));
  return wall;
}

double stiffest(const Scene& scene) {
  double most = 0;
  const auto look = [&most](const auto& things) {
    for (const auto& thing : things) most = std::max(most, thing.material.stiffness);
  };
  look(scene.planes);
  look(scene.spheres);
  look(scene.boxes);
  look(scene.meshes);
  return most;
}

}  // namespace

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
  const auto at = [&l](CouplingKind kind) -> TipLimits::Wall& {
    return l.walls[static_cast<std::size_t>(kind)];
  };
  at(CouplingKind::standard) = {spring_at_tip(l.tip, p.k_vc), "felt through the spring k_vc"};
  at(CouplingKind::proposed) = {proposed_wall(l.tip, s),
                                "the damping there is against the lag of the contact"};
  at(CouplingKind::predictive) = predictive_wall(l, s, p);
  l.every_hand = every_hands_wall(l.tip, p.tick, l.delay);
  l.scene = stiffest(scene);
  l.felt = {(1 + p.inertia_ratio) * l.tip.mass,
            l.tip.damping,
            p.b_v / lever2,
            p.k_vc / lever2,
            p.b_vc / lever2,
            p.tick,
            0};
  l.w_f = p.alpha / lever2 / l.felt.m;
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

FeltAtTip felt_at_tip(const TipLimits& l, const Parameters& p, CouplingKind kind, double f) {
  std::complex<double> Z;
  switch (kind) {
    case CouplingKind::standard: Z = l.felt.standard(f); break;
    case CouplingKind::proposed: Z = l.felt.proposed(f, p.eta, l.w_f); break;
    case CouplingKind::predictive:
      Z = l.felt.predictive(f, p.eta, p.damping_share(p.eta), p.band);
      break;
  }
  return {Z.imag() / (2 * std::numbers::pi * f), Z.real()};
}

}  // namespace limpid
