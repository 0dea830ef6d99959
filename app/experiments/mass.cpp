// Felt mass of a held body over frequency, and the least mass of a body that can be held, over the
// stiffness that holds it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/experiments/felt_impedance.h"
#include "app/experiments/moving.h"
#include "app/experiments/staggered.h"

namespace limpid {
namespace {

constexpr double kHeldMasses[] = {0.005, 0.05, 0.5};                   // [kg]
constexpr double kHeld = 5000, kHeldSoftly = 600;                      // [N/m]
constexpr double kSpeck = 1e-6;                                        // [kg]
constexpr double kHeldTick = 0.001, kHeldPeriod = 2, kHeldSettle = 6;  // [s]
constexpr double kHeldAmplitude = 2.5e-4;                              // at 1 Hz [m]
constexpr double kHeldLines[] = {0.5, 1, 2, 3, 5};                     // [Hz]
constexpr double kHeldGrip = 3000;                                     // [N/m]
constexpr double kHeldDamping = 2;  // of the staggered coupling [N s/m]
constexpr double kHeldTip = 0.004, kHeldCube = 0.01, kHeldGap = 0.002;  // [m]

// Scene: a ball as the tip, and beside it a cube whose centre of mass is at the tip. Held there by
// the magnet it is a point mass.
std::string held_cube(double mass, double stiffness) {
  const double below = kHeldTip + kHeldGap + kHeldCube / 2;
  return scene_of({{.name = "cube",
                    .size = Vec3::Constant(kHeldCube),
                    .mass = mass,
                    .at = kHome - below * Vec3::UnitZ(),
                    .stiffness = stiffness,
                    .more = fmt::format("center = [0, 0, {:.9g}]\nmagnet = true\n", below)}},
                  fmt::format("gravity = [0, 0, 0]\ntip_radius = {}\n", kHeldTip));
}

// A way to hold a body: a law, or the staggered coupling.
struct HeldWay {
  std::string label;
  const char* ink;
  std::optional<CouplingKind> law;
  double eta = 1;
  double stiffness = kHeld;  // [N/m]

  // Mass that is shaken alone and subtracted [kg]. The predictive law gives back no damping while
  // the magnet holds something, so it needs a speck; under the other laws so light a body would not
  // stay.
  double instead() const { return law == CouplingKind::predictive ? kSpeck : 0; }
  Parameters parameters(const ExperimentArm& on) const {
    Parameters p = on.settings;
    if (law) p.kind = *law;
    p.eta = eta;
    p.hand_stiffness = kHeldGrip;
    return p;
  }
};

std::vector<HeldWay> held_ways() {
  using enum CouplingKind;
  return {{"predictive", kPredictiveInk, predictive},
          {"predictive, eta = 0.3", kPredictiveTint, predictive, 0.3},
          {"proposed", kProposedInk, proposed},
          {"standard", kStandardInk, standard},
          {fmt::format("staggered, {} N s/m", kHeldDamping), kContactInk, {}},
          {fmt::format("predictive, in a grip of {} N/m", kHeldSoftly), kEnergyInk, predictive, 1,
           kHeldSoftly}};
}

HandPath shaking_hand() {
  Multisine signal{1 / kHeldPeriod, {}};
  double phase = 0;
  for (const double f : kHeldLines) {
    signal.lines.push_back(
        {static_cast<int>(std::lround(f * kHeldPeriod)), kHeldAmplitude / f, phase});
    phase += 1.1;
  }
  const Vec3 along = Vec3(1, 0.8, 0.6).normalized();
  HandPath path = hand_path(
      fmt::format("shaking at {} frequencies, {} m at 1 Hz", std::size(kHeldLines), kHeldAmplitude),
      kHeldTick, kHeldSettle + kHeldPeriod + kHeldTick, [signal, along](double t) {
        return Vec3(kHome + minimum_jerk(t / 0.5) * signal.at(t) * along);
      });
  path.magnet.assign(path.time.size(), true);
  return path;
}

double mass_of_theory(double mass, double stiffness, double f) {
  const double w = 2 * std::numbers::pi * f;
  return mass / (1 - mass * w * w / stiffness);
}

// Felt mass of a body at each frequency [kg]; empty if it was not held to the end.
struct FeltBody {
  HeldWay way;
  double mass;
  std::vector<double> felt = {};

  // Largest error against theory, relative; NaN if nothing was felt.
  double off() const {
    double most = felt.empty() ? std::nan("") : 0;
    for (std::size_t i = 0; i < felt.size(); ++i) {
      most =
          worse(most, std::abs(felt[i] / mass_of_theory(mass, way.stiffness, kHeldLines[i]) - 1));
    }
    return most;
  }
};

std::vector<double> masses_of(const TipRecord& record) {
  std::vector<double> felt;
  const auto settled = static_cast<std::size_t>(std::llround(kHeldSettle / kHeldTick));
  for (const double f : kHeldLines) felt.push_back(felt_mass(record, settled, f));
  return felt;
}

Trial held_and_shaken(const ExperimentArm& on, const HeldWay& way, double mass) {
  const Parameters p = way.parameters(on);
  const std::string scene = mass > 0 ? held_cube(mass, way.stiffness) : kFreeSpace;
  Trial trial{fmt::format("{}-eta-{}-{}-g-{}", name(p.kind), p.eta, 1e3 * mass, way.stiffness),
              plan_in(on.description, scene, shaking_hand(), p)};
  trial.may_diverge = p.kind != CouplingKind::predictive;
  return trial;
}

std::vector<double> felt_staggered(const ExperimentArm& on, const HeldWay& way, double mass) {
  StaggeredBody body{.mass = mass, .stiffness = way.stiffness, .damping = kHeldDamping};
  if (mass == 0) body = {.mass = 1, .stiffness = 0};
  const StaggeredRun run = run_staggered(on.description, way.parameters(on), shaking_hand(), body);
  return run.diverged ? std::vector<double>{} : masses_of(run.record);
}

// Whether the magnet still holds at the end: where a law cannot hold a body, its force grows until
// the magnet lets go. True without a body.
bool held_to_the_end(const TrialResult& r) {
  const Session& s = r.session;
  if (r.end.diverged) return false;
  return s.info.bodies.empty() || s.at(s.size() - 1, Column::magnet)[0] > 0;
}

// Felt masses of all bodies, less those of the same shaking with instead().
std::vector<FeltBody> feel_bodies(TrialRunner& lab) {
  std::vector<FeltBody> all;
  std::vector<Trial> trials;
  for (const HeldWay& way : held_ways()) {
    for (const double mass : {way.instead(), 0.005, 0.05, 0.5}) {
      // 500 g held so softly would swing at 5.5 Hz.
      if (way.stiffness == kHeldSoftly && mass == kHeldMasses[2]) continue;
      all.push_back({way, mass});
      if (way.law) trials.push_back(held_and_shaken(lab.arm(), way, mass));
    }
  }
  const ExperimentArm& on = lab.arm();
  const std::vector<TrialResult> results = lab.run(trials);
  auto result = results.begin();
  std::vector<double> alone;
  for (FeltBody& one : all) {
    if (!one.way.law) {
      one.felt = felt_staggered(on, one.way, one.mass);
    } else if (const TrialResult& r = *result++; held_to_the_end(r)) {
      one.felt = masses_of(tip_record(on.description, r.session));
    }
    const bool instead = one.mass == one.way.instead();
    if (instead) alone = one.felt;
    for (std::size_t i = 0; !instead && i < one.felt.size(); ++i) one.felt[i] -= alone[i];
  }
  std::erase_if(all, [](const FeltBody& one) { return one.mass == one.way.instead(); });
  return all;
}

// Sentence on the bodies that were not held, with a space behind it; empty if all were.
std::string not_held(const std::vector<FeltBody>& all) {
  std::vector<std::string> words;
  for (const FeltBody& one : all) {
    if (one.felt.empty()) words.push_back(fmt::format("{} ({} g)", one.way.label, 1e3 * one.mass));
  }
  if (words.empty()) return "";
  return fmt::format(
      "These cubes fell off the magnet that lifts them, so their curves are missing: {}. ",
      fmt::join(words, ", "));
}

FigurePanel felt_panel(const std::vector<FeltBody>& all, double mass) {
  FigurePanel panel{.title = fmt::format("Mass felt for a cube of {} g", 1e3 * mass),
                    .x_label = "frequency [Hz]",
                    .y_label = "mass felt / mass given [-]",
                    .log_x = true,
                    .x_range = std::pair(0.4, 6.0),
                    .y_range = std::pair(0.7, 1.5)};
  panel.x_ticks = {{0.5, "0.5"}, {1, "1"}, {2, "2"}, {3, "3"}, {5, "5"}};
  Series line{"theory, 1 / (1 - m w^2 / K)", kHandInk, Series::Style::dashed, {}};
  for (double f = 0.45; f < 5.6; f *= 1.05)
    line.points.push_back({f, mass_of_theory(mass, kHeld, f) / mass});
  panel.series.push_back(line);
  for (const FeltBody& one : all) {
    if (one.mass != mass || one.felt.empty()) continue;
    Series curve{one.way.label, one.way.ink, Series::Style::line, {}};
    for (std::size_t i = 0; i < one.felt.size(); ++i) {
      curve.points.push_back({kHeldLines[i], one.felt[i] / mass});
    }
    panel.series.push_back(curve);
    panel.series.push_back({"", one.way.ink, Series::Style::points, curve.points});
  }
  return panel;
}

constexpr double kStiffnesses[] = {100, 200, 500, 1000, 2000, 5000, 10000, 20000};  // [N/m]
constexpr double kLightest = 1e-4, kHeaviest = 3;                                   // tried [kg]
constexpr double kStillDevice = 5000;  // device stiff enough to stand still for theory [N/m]
constexpr double kNudge = 1e-4;        // [m]
constexpr double kStrongMotors = 100;  // [N m]
constexpr int kHalvings = 10;

HandPath nudging_hand() {
  HandPath path = hand_path(fmt::format("nudged by {} m", kNudge), kHeldTick, 1, [](double t) {
    return Vec3(kHome + (t > 0.01 ? kNudge : 0) * Vec3::UnitZ());
  });
  path.magnet.assign(path.time.size(), true);
  return path;
}

Parameters in_a_still_hand(const ExperimentArm& on) {
  Parameters p = on.settings;
  p.kind = CouplingKind::predictive;
  p.hand_stiffness = kHeldGrip;
  p.torque_limit = kStrongMotors;
  return p;
}

// Least stable mass for each stiffness, between kLightest and kHeaviest; none if even the heaviest
// is unstable.
using StableMasses = std::function<std::vector<char>(const std::vector<double>& masses)>;
std::vector<std::optional<double>> least_masses(const StableMasses& stable) {
  constexpr std::size_t n = std::size(kStiffnesses);
  const std::vector<char> at_lightest = stable(std::vector<double>(n, kLightest)),
                          at_heaviest = stable(std::vector<double>(n, kHeaviest));
  std::vector<double> low(n, kLightest), high(n, kHeaviest), at(n);
  for (int i = 0; i < kHalvings; ++i) {
    for (std::size_t k = 0; k < n; ++k) at[k] = std::sqrt(low[k] * high[k]);
    const std::vector<char> good = stable(at);
    for (std::size_t k = 0; k < n; ++k) (good[k] != 0 ? high : low)[k] = at[k];
  }
  std::vector<std::optional<double>> least(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (at_lightest[k] != 0) {
      least[k] = kLightest;
    } else if (at_heaviest[k] != 0) {
      least[k] = high[k];
    }
  }
  return least;
}

// Whether the lightest body is stable under the predictive law, for each stiffness.
std::vector<char> stable_with_the_lightest(TrialRunner& lab) {
  std::vector<Trial> trials;
  for (const double K : kStiffnesses) {
    trials.push_back({"", plan_in(lab.arm().description, held_cube(kLightest, K), nudging_hand(),
                                  in_a_still_hand(lab.arm()))});
    trials.back().keep = false;
  }
  std::vector<char> good(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) {
    std::vector<double> speeds;
    for (std::size_t k = 0; k < r.session.size(); ++k) {
      speeds.push_back(vector_at(r.session, k, Column::body_velocity).head<3>().norm());
    }
    good[i] = held_to_the_end(r) && dies_away(speeds) ? 1 : 0;
  });
  return good;
}

StableMasses when_staggered(const ExperimentArm& on, double damping) {
  return [&on, damping](const std::vector<double>& masses) {
    std::vector<char> good(masses.size());
    for (std::size_t k = 0; k < masses.size(); ++k) {
      const StaggeredRun run =
          run_staggered(on.description, in_a_still_hand(on), nudging_hand(),
                        {.mass = masses[k], .stiffness = kStiffnesses[k], .damping = damping});
      good[k] = !run.diverged && dies_away(run.speed) ? 1 : 0;
    }
    return good;
  };
}

// Curve of the staggered coupling, with the line of theory.
void add_staggered(const ExperimentArm& on, double damping, const char* ink, FigurePanel& panel,
                   std::vector<Check>& checks) {
  const std::string law = damping > 0 ? "K T^2/4 + B T/2" : "K T^2/4";
  Series line{law, ink, Series::Style::dashed, {}};
  for (double K = 100; K < 20001; K *= 1.1) {
    line.points.push_back({K, 1e3 * least_staggered_mass(K, damping, kHeldTick)});
  }
  const auto least = least_masses(when_staggered(on, damping));
  Series curve{fmt::format("staggered, {} N s/m", damping), ink, Series::Style::line, {}};
  double off = 0;
  for (std::size_t k = 0; k < least.size(); ++k) {
    const double K = kStiffnesses[k], wanted = least_staggered_mass(K, damping, kHeldTick);
    if (least[k]) curve.points.push_back({K, 1e3 * *least[k]});
    if (K <= kStillDevice)
      off = worse(off, least[k] ? std::abs(*least[k] / wanted - 1) : std::nan(""));
  }
  panel.series.insert(panel.series.end(),
                      {line, curve, {"", ink, Series::Style::points, curve.points}});
  if (damping == 0) return;
  checks.push_back(at_most(fmt::format("staggered, {} N s/m: relative deviation of the smallest "
                                       "stable mass from {}, up to {} N/m",
                                       damping, law, kStillDevice),
                           off, 0.1));
}

FigurePanel least_panel(TrialRunner& lab, std::vector<Check>& checks) {
  FigurePanel panel{.title = "The smallest mass that can be held",
                    .x_label = "stiffness that holds the mass [N/m]",
                    .y_label = "smallest stable mass [g]",
                    .log_x = true,
                    .log_y = true,
                    .x_range = std::pair(80.0, 25000.0),
                    .y_range = std::pair(0.05, 1000.0)};
  add_staggered(lab.arm(), kHeldDamping, kContactInk, panel, checks);
  add_staggered(lab.arm(), 0, kDeviceInk, panel, checks);
  Series ours{fmt::format("predictive: stable with {} g, the lightest tried", 1e3 * kLightest),
              kPredictiveInk,
              Series::Style::line,
              {}};
  const std::vector<char> good = stable_with_the_lightest(lab);
  for (std::size_t k = 0; k < good.size(); ++k) {
    if (good[k] != 0) ours.points.push_back({kStiffnesses[k], 1e3 * kLightest});
  }
  panel.series.insert(panel.series.end(),
                      {ours, {"", kPredictiveInk, Series::Style::points, ours.points}});
  checks.push_back(at_least(fmt::format("predictive: number of stiffnesses from 100 to 20000 N/m, "
                                        "out of {}, at which {} g are held",
                                        good.size(), 1e3 * kLightest),
                            static_cast<double>(ours.points.size()),
                            static_cast<double>(good.size())));
  return panel;
}

}  // namespace

Outcome mass(TrialRunner& lab) {
  const std::vector<FeltBody> all = feel_bodies(lab);
  Outcome outcome;
  outcome.figure.title =
      "The mass felt of a body that is held, and the smallest mass that can be held";
  outcome.figure.columns = 2;
  for (const double mass : kHeldMasses) outcome.figure.panels.push_back(felt_panel(all, mass));
  for (const FeltBody& one : all) {
    if (one.way.law != CouplingKind::predictive) continue;
    outcome.checks.push_back(at_most(
        fmt::format(
            "{}, cube of {} g: relative deviation of the mass felt from m / (1 - m w^2 / K)",
            one.way.label, 1e3 * one.mass),
        one.off(), one.way.eta == 1 ? 0.02 : 0.04));
  }
  outcome.figure.panels.push_back(least_panel(lab, outcome.checks));
  outcome.figure.caption = fmt::format(
      "The magnet holds a cube without weight by the centre of mass, at {} N/m ({} N/m where the "
      "label says so). The hand shakes the tip at five frequencies together: {} mm at 1 Hz and "
      "less at higher frequencies. The mass felt is the hand's force in phase with the tip's "
      "acceleration, minus the same part of the force when the hand shakes a cube of {} mg (under "
      "the other laws: no cube). The spring between tip and cube turns a mass m into m / (1 - m "
      "w^2 / K). {}Staggered means no coupling: the force of a tick is computed from the last "
      "positions of tip and body, and the body moves after the tick. Last panel: the hand suddenly "
      "moves the tip by {} mm, and the cube comes to rest or does not; the motors never reach "
      "their limit. While the device stands still, a staggered body needs a mass of at least K "
      "T^2/4 + B T/2 (Jury). The device does not stand still above {} N/m, or without a damper. "
      "Where a curve ends, no mass up to {} kg is stable.",
      kHeld, kHeldSoftly, 1e3 * kHeldAmplitude, 1e6 * kSpeck, not_held(all), 1e3 * kNudge,
      kStillDevice, kHeaviest);
  return outcome;
}

}  // namespace limpid
