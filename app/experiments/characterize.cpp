#include "app/experiments/characterize.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/run/analysis.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "core/dynamics/inverse_kinematics.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

constexpr double kFreeSettle = 2, kFreePeriods = 2;           // [s]; whole periods of all
constexpr double kMostShaken = 5e-3, kShakenPart = 1 / 60.0;  // at 1 Hz [m]; of the reach
constexpr double kFreeGrip = 3000, kFreeGripDamping = 4;      // [N/m], [N s/m]
constexpr double kFreeJudged = 5;                             // highest that is judged [Hz]
constexpr double kFreeOff = 0.1;                              // mass felt off eta, of it
constexpr double kGiven = 5e-3, kGivenByBounds = 1e-3;        // most energy given [J]
constexpr double kAsNamed = 0.95;                             // wall by the named one

ArmUnderLaw under(const Characterized& subject, CouplingKind kind) {
  ArmUnderLaw at = subject.at;
  at.parameters.kind = kind;
  return at;
}

// Amplitude of the shaking at 1 Hz [m]; all frequencies have the same speed.
double shaken_by(const ArmDescription& arm) {
  return std::min(kMostShaken, kShakenPart * reach(arm));
}

Multisine sine_of(const ArmDescription& arm, double f) { return {f, {{1, shaken_by(arm) / f, 0}}}; }

// The tip shaken about its rest pose, along the direction in which walls are judged; at one
// frequency alone, as friction would mix them.
Trial shaken_at_rest(const ArmUnderLaw& at, double f) {
  const auto& [arm, p] = at;
  const TapPlace place = tap_place(arm, rest_pose(arm), p);
  const auto path = [&place, signal = sine_of(arm, f)](double t) {
    return Vec3(place.point + minimum_jerk(t / 0.5) * signal.at(t) * place.out);
  };
  Trial trial;
  trial.keep = false;
  trial.may_diverge = true;
  RunPlan& plan = trial.plan;
  plan.arm = arm;
  plan.document = parse_scene(kFreeSpace, "scene", {}, arm);
  plan.parameters = p;
  BenchHand{kFreeGrip, kFreeGripDamping}.holds(plan.parameters);
  plan.hand = hand_path(fmt::format("shaking at {} Hz", f), p.tick,
                        kFreeSettle + kFreePeriods + p.tick, path);
  plan.rows = plan.hand.time.size();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(arm.dof());
  plan.start = RigStart{place.x, zero, place.x, zero, zero, place.point, true};
  return trial;
}

// Mass and damping felt at the tip. With J'J in the place of the inertia matrix the "inertia" of
// measured_motion() is the tip's mass, and its damping is per J'J.
FeltMotion felt_at_the_tip(const Trial& trial, const TrialResult& result, double f) {
  const RunPlan& plan = trial.plan;
  const Eigen::MatrixXd J = arm_at(plan.arm, rest_pose(plan.arm)).J;
  const auto settled = static_cast<std::size_t>(std::llround(kFreeSettle / plan.parameters.tick));
  FeltMotion felt =
      measured_motion(result.session, settled, J.transpose() * J, sine_of(plan.arm, f)).front();
  felt.damping /= felt.mass;
  return felt;
}

// Runs the trials, law by law and frequency by frequency.
void measure_free(TrialRunner& lab, const std::vector<Trial>& shaken,
                  std::vector<LawRendered>& laws) {
  constexpr std::size_t kEach = std::size(kFreeTold);
  std::vector<std::optional<FeltMotion>> felt(shaken.size());
  lab.run(shaken, [&](std::size_t i, const TrialResult& result) {
    if (!result.end.diverged) felt[i] = felt_at_the_tip(shaken[i], result, kFreeTold[i % kEach]);
  });
  for (std::size_t i = 0; i < felt.size(); ++i) {
    if (felt[i]) laws[i / kEach].free.push_back(*felt[i]);
  }
}

std::vector<LawRendered> measure(TrialRunner& lab, const Characterized& subject) {
  std::vector<LawRendered> laws;
  std::vector<ArmUnderLaw> all;
  std::vector<ArmTap> taps;
  std::vector<Trial> shaken;
  for (const BenchLaw& law : kBenchLaws) {
    all.push_back(under(subject, law.kind));
    const auto& [arm, p] = all.back();
    const TipLimits tip = tip_limits(arm, rest_pose(arm), p, {});
    const TipWall& wall = tip.wall(law.kind);
    laws.push_back({.kind = law.kind, .named = wall.stiffness, .bound = wall.bound});
    for (const double f : kFreeTold) {
      const FeltAtTip felt = felt_at_tip(law.kind, p, tip, f);
      laws.back().free_named.push_back({f, felt.mass, felt.damping, 1});
      shaken.push_back(shaken_at_rest(all.back(), f));
    }
    for (const BenchHand& hand : kHands) {
      taps.push_back({all.back(), kCommonWall});
      hand.holds(taps.back().at.parameters);
    }
  }
  measure_free(lab, shaken, laws);
  const std::vector<Came> came = tap_arms(lab, taps);
  const std::vector<double> walls = stiffest_quiet_walls(lab, all);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const auto first = came.begin() + static_cast<std::ptrdiff_t>(kHands.size() * i);
    laws[i].taps.assign(first, first + kHands.size());
    laws[i].wall = walls[i];
  }
  return laws;
}

FigurePanel walls_panel(const std::vector<LawRendered>& laws) {
  FigurePanel panel{.title = "The stiffest wall",
                    .y_label = "stiffest wall [N/m]",
                    .log_y = true,
                    .x_range = std::pair(-0.5, double(laws.size()) - 0.5),
                    .y_range = std::pair(0.5 * kLeastWall, 2 * kMostWall)};
  Series measured{
      "measured: felt as stiff as set, and quiet", kDeviceInk, Series::Style::points, {}};
  Series named{"computed by `limpid analyze`", kNeutralInk, Series::Style::points, {}};
  named.mark = 2;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    panel.x_ticks.emplace_back(i, info(laws[i].kind).key);
    measured.points.push_back({double(i), laws[i].wall});
    named.points.push_back({double(i), std::clamp(laws[i].named, kLeastWall, kMostWall)});
  }
  panel.series = {named, measured};
  return panel;
}

FigurePanel given_panel(const std::vector<LawRendered>& laws) {
  std::vector<LawCame> all;
  for (const LawRendered& law : laws) {
    for (const Came& came : law.taps) all.push_back({law.kind, came});
  }
  return energy_panel(fmt::format("A wall of {} N/m, four hands", kCommonWall), all);
}

FigurePanel free_panel(const std::vector<LawRendered>& laws, const char* title, const char* y,
                       double FeltMotion::*value, double scale) {
  FigurePanel panel{.title = title, .x_label = "frequency [Hz]", .y_label = y, .log_x = true};
  panel.x_range = {0.45, 11};
  for (const LawRendered& law : laws) {
    Series line = bench_law(law.kind).line();
    for (const FeltMotion& m : law.free) line.points.push_back({m.f, scale * m.*value});
    panel.series.push_back(line);
  }
  return panel;
}

// Closed forms of one direction, without friction and encoder steps, judge no arm of any kind.
constexpr const char* kNoPromise =
    "The formula is for one direction, without friction and encoder steps. So it promises nothing "
    "for an arm.";

void judge_walls(const Characterized& subject, const LawRendered& law, std::vector<Check>& checks) {
  const auto& [arm, p] = under(subject, law.kind);
  if (law.kind == CouplingKind::predictive) {
    const double named = std::clamp(law.named, kLeastWall, kMostWall * kAsNamed);
    checks.push_back(
        at_least("predictive: stiffest wall, divided by the wall that `limpid analyze` computes",
                 law.wall / named, kAsNamed));
  }
  if (law.kind == CouplingKind::direct) {
    const ArmAt at = arm_at(arm, rest_pose(arm));
    const Eigen::VectorXd b = device_damping(arm, p);
    const TipAlong tip = tip_along(at.J, at.M, b, least_damped(at.J, b));
    const double theory = direct_wall(
        tip, {.T = p.tick, .hand_damping = kHands[0].damping, .delay = device_delay(arm, p)});
    for (Check check :
         by_direct_theory("direct coupling: stiffest wall, divided by (b_d + b_h)/(T/2 + delay)",
                          law.wall / theory)) {
      check.unjudged = kNoPromise;
      checks.push_back(std::move(check));
    }
  }
}

void judge_energy(const LawRendered& law, std::vector<Check>& checks) {
  const std::string what = fmt::format("{}: largest energy given to the hand [J]", name(law.kind));
  if (law.kind == CouplingKind::predictive || law.kind == CouplingKind::tank) {
    checks.push_back(at_most(what, law.most_given(), kGiven));
  }
  if (law.kind == CouplingKind::eba) {
    checks.push_back(at_most(what, law.most_given(), kGivenByBounds));
  }
}

void judge_free(const LawRendered& law, std::vector<Check>& checks) {
  if (law.kind != CouplingKind::predictive) return;
  double off = 0;
  for (const FeltMotion& named : law.free_named) {
    if (named.f > kFreeJudged) continue;
    const FeltMotion* const felt = at_frequency(law.free, named.f);
    off = worse(off, felt == nullptr ? std::nan("") : std::abs(felt->inertia / named.inertia - 1));
  }
  Check check = at_most(
      "predictive: relative deviation of the mass felt from the mass that `limpid analyze` "
      "computes, 0.5 to 5 Hz",
      off, kFreeOff);
  check.unjudged = kNoPromise;
  checks.push_back(std::move(check));
}

std::string caption(const Characterized& subject) {
  return fmt::format(
      "{}. The tip taps a wall in front of the rest pose, at {} m/s. Then the hand presses with {} "
      "N, or with half of the motors' limit if that is smaller. Grips are 300 and 3,000 N/m, with "
      "2 N s/m and without damping. Stiffest wall: the stiffness felt differs from the stiffness "
      "set by at most {} %, and the rms speed of the tip above 20 Hz is at most {} mm/s, in both "
      "grips with damping. Walls from {} to {} N/m were tried. The energy is the largest energy "
      "that the hand was given. In free motion the tip is moved to and fro at one frequency after "
      "the other: {:.1f} mm at 1 Hz, with the same speed at all frequencies, in a grip of {} N/m "
      "and {} N s/m. Friction of the arm is felt as damping.",
      subject.name, WallTap::kSpeed, kHardest, 100 * kFeltOff, 1e3 * kQuiet, kLeastWall, kMostWall,
      1e3 * shaken_by(subject.at.arm), kFreeGrip, kFreeGripDamping);
}

}  // namespace

double LawRendered::most_given() const {
  double most = 0;
  for (const Came& came : taps) most = worse(most, came.port);
  return most;
}

std::pair<double, double> LawRendered::felt() const {
  double least = HUGE_VAL, most = 0;
  for (const Came& came : taps) {
    if (!std::isfinite(came.total)) continue;
    least = std::min(least, kCommonWall * came.felt);
    most = std::max(most, kCommonWall * came.felt);
  }
  return {least, most};
}

Characterization characterize(TrialRunner& lab, const Characterized& subject) {
  Characterization found{measure(lab, subject), {}};
  Figure& figure = found.outcome.figure;
  figure.title = "What " + subject.name + " can render";
  figure.caption = caption(subject);
  figure.columns = 2;
  figure.panels = {walls_panel(found.laws), given_panel(found.laws),
                   free_panel(found.laws, "Free motion: mass felt at the tip", "mass [g]",
                              &FeltMotion::inertia, 1e3),
                   free_panel(found.laws, "Free motion: damping felt at the tip", "damping [N s/m]",
                              &FeltMotion::damping, 1)};
  for (const LawRendered& law : found.laws) {
    judge_walls(subject, law, found.outcome.checks);
    judge_energy(law, found.outcome.checks);
    judge_free(law, found.outcome.checks);
  }
  figure.caption += " " + lab.conditions().text();
  return found;
}

}  // namespace limpid
