// Limits of the predictive law at the tip of an arm: its walls, and the impedance that is felt.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/encoder_filter.h"
#include "core/coupling/law_at_tip.h"
#include "core/coupling/laws.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

// Stiffest walls that were tried: with exact encoders, and with steps.
constexpr double kTried = 20000, kTriedStepped = 10000;  // [N/m]
constexpr double kTriedTick = 0.001;                     // of these trials [s]
// Bounds of K in m_n over the square of a time [-]. kQuick: of a tick, found with 24 arms, failing
// from 3 on. The others: of a delay that is not known to the law, of a known one, and of one with
// encoder steps that make the estimate jump by more than kJump.
constexpr double kQuick = 2, kUnforeseen = 0.3, kForeseen = 0.2, kForeseenCoarse = 0.08;
constexpr double kJump = 0.01;        // [m/s]
constexpr double kSofter = 1.0 / 25;  // part of a wall that the proxy's inertia may take off
// Largest force that a step of the encoder may make of a wall, and largest speed of a tip inside a
// cell, which in theory swings there with kSwing of step times natural frequency.
constexpr double kStepForce = 0.25, kCellSpeed = 5e-3, kSwing = 0.6;  // [N], [m/s], [-]

// Walls of a tip whose encoders have a step q [m]; t_d: delay of the torque [s].
struct StepWalls {
  double mass, q, t_d;  // [kg, m, s]

  double bandwidth(double K) const { return filter_bandwidth(resting_rate(K, mass, q) / mass, q); }
  // Growth of an error of the position until the torque meets the device.
  double growth(double K) const {
    const double a = bandwidth(K) * t_d;
    return 1 + a + a * a / 2;
  }
  // Stiffest wall of which an error by a step makes at most a force F.
  double by_force(double F) const {
    double low = 0, high = 2 * kTried;
    for (int i = 0; i < 40; ++i) {
      const double K = (low + high) / 2;
      (K * q * growth(K) <= F ? low : high) = K;
    }
    return low;
  }
  double by_cell() const {
    const double w = kCellSpeed / (kSwing * q);
    return mass * w * w;
  }
};

// Friction at the tip of a Touch, as an example for arms without any [N].
constexpr double kUsualFriction = 0.26;

// The bound of a wall, in words. `setting`: the one that it was found for.
std::string told(const BoundedWall& wall, PredictiveWallSetting setting, const LawAtTip& at) {
  const double q_t = 1000 * setting.encoder_step * at.easiest.lever;  // [mm]
  switch (wall.by) {
    case WallBound::tried:
      return fmt::format("no stiffer wall was tested{}{}",
                         setting.encoder_step > 0 ? " with encoder steps" : "",
                         at.loop.T > 1.001 * kTriedTick ? " at a tick of this length" : "");
    case WallBound::quick:
      return fmt::format(
          "the tip's mass is {:.2g} g, so the tip moves far in a tick, and no values of the hand "
          "are known",
          1000 * at.easiest.mass);
    case WallBound::proxy:
      return "above this stiffness the hand would feel the proxy's inertia through k_vc";
    case WallBound::step:
      return fmt::format("at this wall an encoder step of {:.2g} mm at the tip pushes with 0.25 N",
                         q_t);
    case WallBound::friction:
      return fmt::format(
          "{:.2g} N of friction are just enough to hold the tip inside an encoder step of {:.2g} "
          "mm",
          setting.friction, q_t);
    case WallBound::cell:
      setting.friction = kUsualFriction;
      return fmt::format(
          "the tip can swing inside an encoder step of {:.2g} mm, and no reading shows it; with {} "
          "N of friction the wall may have {:.0f} N/m",
          q_t, kUsualFriction, predictive_wall(at.easiest, setting).stiffness);
    case WallBound::hand: return "the hand is heavier than the predictor assumes";
    case WallBound::delay: break;
  }
  const bool known = std::abs(at.loop.delay - setting.delay_foreseen) <= at.loop.T / 2 * (1 + 1e-9);
  return fmt::format("a delay of {:.1f} ms{}", 1e3 * at.loop.delay,
                     known ? "" : "; model.delay does not include this delay");
}

}  // namespace

BoundedWall predictive_wall(const TipMoved& tip, const PredictiveWallSetting& s) {
  const double T = s.at.T, q = s.encoder_step;
  BoundedWall wall{kTried * std::min(1.0, power(kTriedTick / T, 2.5)), WallBound::tried};
  const auto bound = [&](double stiffness, WallBound by) {
    if (stiffness < wall.stiffness) wall = {stiffness, by};
  };
  bound(kQuick * tip.mass / (T * T), WallBound::quick);
  bound(kSofter * s.at.k_vc / (s.inertia_ratio * tip.lever * tip.lever), WallBound::proxy);
  const StepWalls steps{tip.mass, q * tip.lever, s.at.delay};
  if (q > 0) {
    bound(kTriedStepped, WallBound::tried);
    bound(steps.by_force(kStepForce), WallBound::step);
    const double cell = steps.by_cell(), held = steps.by_force(2 * s.friction);
    bound(std::max(cell, held), held > cell ? WallBound::friction : WallBound::cell);
  }
  if (s.at.hand_mass > s.mass_foreseen) {
    const TipAlong along{.mass = tip.mass, .lever2 = tip.lever * tip.lever};
    bound(mistaken_wall(along, s.at) / 2, WallBound::hand);
  }
  const auto late = [&](double by, double part) {
    if (by > T / 4) bound(part * tip.mass / (by * by), WallBound::delay);
  };
  late(std::abs(s.at.delay - s.delay_foreseen), kUnforeseen);
  const bool jumps = q > 0 && steps.q * steps.bandwidth(0) > kJump;
  late(s.at.delay, jumps                                     ? kForeseenCoarse
                   : q == 0 && s.at.delay > s.delay_foreseen ? kUnforeseen
                                                             : kForeseen);
  return wall;
}

TipWall PredictiveLaw::wall(const LawSettings& p, const LawAtTip& at) {
  PredictiveWallSetting setting{at.loop,     at.encoder_step,     at.friction,
                                p.hand_mass, p.delay * at.loop.T, at.inertia_ratio};
  setting.at.k_vc = at.easiest_weight * p.k_vc;
  setting.at.b_v = at.easiest_weight * p.b_v;
  const BoundedWall wall = predictive_wall(at.easiest, setting);
  return {wall.stiffness, told(wall, setting, at)};
}

FeltAtTip PredictiveLaw::felt(const LawSettings& p, const LawAtTip& at, double f) {
  const LateMotors late{at.loop.delay, std::max(0.0, at.loop.delay - p.delay * at.loop.T)};
  return felt_mass(at.felt.predictive(f, at.added, p.damping_share(p.eta), p.band, late), f);
}

}  // namespace limpid
