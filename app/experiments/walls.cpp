// Walls of random arms: tapped at the stiffness that `limpid analyze` computes for each.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/experiment.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/random.h"
#include "core/dynamics/random_arm.h"

namespace limpid {
namespace {

// Values varied, and bounds promised.
struct WallsPlan {
  static constexpr int kArms = 36, kMostJoints = 12;         // three arms of each number of joints
  static constexpr double kLightest = 0.02, kHeaviest = 30;  // [kg]
  static constexpr unsigned kSeed = 100;                     // of the first arm
  static constexpr double kSteps[] = {0, 1e-5, 1e-4};        // of encoders [rad]
  // Grips of desktop devices and of robots.
  static constexpr double kRobot = 5;  // heavier arms are robots [kg]
  struct Grip {
    double stiffness, damping;  // [N/m, N s/m]
  };
  static constexpr Grip kDesktopGrips[] = {{300, 2}, {3000, 5}};
  static constexpr Grip kRobotGrips[] = {{1000, 5}, {3000, 10}};
  static constexpr double kPress = 4;                  // at most, within the motors' limits [N]
  static constexpr double kGiven = 5e-3, kOff = 0.05;  // [J]; off the stiffness set [-]
  static constexpr double kRattle = 0.1, kRobotRattle = 2;  // share of the press [-]; robots' [N]
  static constexpr double kSoftestNamed = 10;               // softer ones count as no wall [N/m]
  static constexpr int kNamed[] = {36, 36, 24};             // arms with a wall, for each step
};

// A random arm in a random pose.
struct AnyArm {
  ArmDescription arm;
  Eigen::VectorXd x;
  double mass = 0;  // [kg]

  bool robot() const { return mass >= WallsPlan::kRobot; }
  std::span<const WallsPlan::Grip> grips() const {
    return robot() ? WallsPlan::kRobotGrips : WallsPlan::kDesktopGrips;
  }
};

// The i-th arm; masses come in an order that does not follow the number of joints.
AnyArm any_arm(int i) {
  using P = WallsPlan;
  const int joints = 1 + i % P::kMostJoints;
  const unsigned seed = P::kSeed + static_cast<unsigned>(i);
  const double part = static_cast<double>(11 * i % P::kArms) / (P::kArms - 1);
  AnyArm any;
  any.mass = P::kLightest * power(P::kHeaviest / P::kLightest, part);
  any.arm = weighing(random_arm(joints, seed), any.mass);
  any.x = Random(seed + 1000).vector(joints, 0.6);
  return any;
}

// Parameters with the gains that the program fits to the arm.
Parameters wall_parameters(const ArmDescription& arm, double step) {
  Parameters p = fitted(arm);
  p.kind = CouplingKind::predictive;
  p.encoder_step = step;
  return p;
}

// Worst results of both grips for an arm with an encoder.
struct WallFelt {
  double mass = 0;    // of the arm [kg]
  double named = 0;   // [N/m]
  double port = 0;    // most that the hand was given [J]
  double felt = 1;    // felt stiffness over the one set, where furthest from 1 [-]
  double rattle = 0;  // rms force above 20 Hz, over the one allowed [-]

  bool has_wall() const { return named >= WallsPlan::kSoftestNamed; }
};

struct AnyTap {
  Trial trial;
  TapPlace place;
  WallTap tap;
  double allowed = 0;  // rms force above 20 Hz [N]
};

AnyTap any_tap(const AnyArm& any, double step, const WallsPlan::Grip& grip, double wall) {
  Parameters p = wall_parameters(any.arm, step);
  p.hand_stiffness = grip.stiffness;
  p.hand_damping = grip.damping;
  AnyTap tap;
  tap.place = tap_place(any.arm, any.x, p);
  tap.tap.wall = wall;
  tap.tap.press = bearable_press(any.arm, tap.place, p, WallsPlan::kPress);
  if (any.robot()) tap.tap.hold = 1;  // a heavy one swings for longer
  tap.allowed = any.robot() ? WallsPlan::kRobotRattle : WallsPlan::kRattle * tap.tap.press;
  tap.trial = {"", tap_plan(any.arm, tap.place, tap.tap, p)};
  tap.trial.keep = false;
  return tap;
}

using Felts = std::vector<WallFelt>;  // of each arm

// Results for every step of the encoders.
std::vector<Felts> tap_all(TrialRunner& lab) {
  std::vector<Felts> felts;
  std::vector<AnyTap> taps;
  std::vector<WallFelt*> of;
  for (const double step : WallsPlan::kSteps) {
    felts.emplace_back(WallsPlan::kArms);
    for (int i = 0; i < WallsPlan::kArms; ++i) {
      const AnyArm any = any_arm(i);
      WallFelt& felt = felts.back()[static_cast<std::size_t>(i)];
      const TipLimits limits = tip_limits(any.arm, any.x, wall_parameters(any.arm, step), {});
      felt.mass = any.mass;
      felt.named = limits.wall(CouplingKind::predictive).stiffness;
      if (!felt.has_wall()) continue;  // counted: see kNamed
      for (const WallsPlan::Grip& grip : any.grips()) {
        taps.push_back(any_tap(any, step, grip, felt.named));
        of.push_back(&felt);
      }
    }
  }
  std::vector<Trial> trials;
  for (const AnyTap& tap : taps) trials.push_back(tap.trial);
  struct Came {
    double port = 0, felt = 0, rattle = 0;
  };
  std::vector<Came> came(taps.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) {
    WallMeter meter = tap_meter(trials[i].plan, taps[i].tap);
    for (std::size_t k = 0; k < r.session.size(); ++k) {
      meter.add(r.session.layout, r.session.row(k));
      came[i].port = worse(came[i].port, r.session.at(k, Column::energy_port)[0]);
    }
    came[i].felt = r.end.diverged ? 0 : meter.felt();
    came[i].rattle = r.end.diverged ? HUGE_VAL : meter.rattle();
  });
  for (std::size_t i = 0; i < taps.size(); ++i) {
    WallFelt& felt = *of[i];
    felt.port = worse(felt.port, came[i].port);
    felt.rattle = worse(felt.rattle, came[i].rattle / taps[i].allowed);
    if (!(std::abs(came[i].felt - 1) <= std::abs(felt.felt - 1))) felt.felt = came[i].felt;
  }
  return felts;
}

std::string step_label(double step) {
  return step > 0 ? fmt::format("encoders of {} rad", step) : "exact encoders";
}

// A dot for each arm over its mass, a little apart for each encoder; values beyond the frame are
// drawn at its edge.
template <class Value>
FigurePanel against_mass(const std::vector<Felts>& felts, const std::string& title,
                         const std::string& y, std::pair<double, double> range,
                         const Value& value) {
  FigurePanel panel{.title = title, .x_label = "mass of the arm [kg]", .y_label = y, .log_x = true};
  panel.x_range = {0.015, 40};
  panel.y_range = range;
  for (std::size_t q = 0; q < felts.size(); ++q) {
    Series points{step_label(WallsPlan::kSteps[q]), kFamilyInk[q], Series::Style::points, {}};
    for (const WallFelt& felt : felts[q]) {
      if (!felt.has_wall()) continue;
      const double found = value(felt), apart = 1 + 0.06 * (static_cast<double>(q) - 1);
      points.points.push_back(
          {apart * felt.mass,
           std::isnan(found) ? range.second : std::clamp(found, range.first, range.second)});
    }
    panel.series.push_back(points);
  }
  return panel;
}

void add_line(FigurePanel& panel, double value, const std::string& label) {
  panel.series.push_back({label, kHandInk, Series::Style::dashed, {{0.015, value}, {40, value}}});
}

std::vector<FigurePanel> draw(const std::vector<Felts>& felts) {
  FigurePanel named =
      against_mass(felts, "The wall that `limpid analyze` computes", "stiffness [N/m]", {10, 30000},
                   [](const WallFelt& f) { return f.named; });
  FigurePanel felt =
      against_mass(felts, "Stiffness felt, divided by the stiffness set", "felt / set [-]",
                   {0, 1.5}, [](const WallFelt& f) { return f.felt; });
  FigurePanel rattle = against_mass(
      felts, "Force above 20 Hz while the hand presses, divided by the force allowed",
      "rms force / force allowed [-]", {1e-4, 100}, [](const WallFelt& f) { return f.rattle; });
  FigurePanel given = against_mass(felts, "Largest energy given to the hand", "energy [mJ]",
                                   {1e-3, 1000}, [](const WallFelt& f) { return 1e3 * f.port; });
  named.log_y = rattle.log_y = given.log_y = true;
  add_line(felt, 1 + WallsPlan::kOff, "bounds");
  add_line(felt, 1 - WallsPlan::kOff, "");
  add_line(rattle, 1, "bound");
  add_line(given, 1e3 * WallsPlan::kGiven, "bound");
  return {named, felt, rattle, given};
}

void judge(const std::vector<Felts>& felts, std::vector<Check>& checks) {
  using P = WallsPlan;
  for (std::size_t q = 0; q < felts.size(); ++q) {
    WallFelt worst;
    int walls = 0;
    for (const WallFelt& felt : felts[q]) {
      if (!felt.has_wall()) continue;
      ++walls;
      worst.port = worse(worst.port, felt.port);
      worst.rattle = worse(worst.rattle, felt.rattle);
      if (!(std::abs(felt.felt - 1) <= std::abs(worst.felt - 1))) worst.felt = felt.felt;
    }
    const std::string where = step_label(P::kSteps[q]) + ": ";
    checks.push_back(at_least(
        where + fmt::format("number of arms for which `limpid analyze` computes a wall, of {} arms",
                            P::kArms),
        walls, P::kNamed[q]));
    checks.push_back(
        at_most(where + "relative deviation of the stiffness felt from the stiffness set",
                std::abs(worst.felt - 1), P::kOff));
    checks.push_back(
        at_most(where + "rms force above 20 Hz, divided by the force allowed", worst.rattle, 1));
    checks.push_back(
        at_most(where + "largest energy given to the human [J]", worst.port, P::kGiven));
  }
}

}  // namespace

Outcome walls(TrialRunner& lab) {
  const std::vector<Felts> felts = tap_all(lab);
  Outcome outcome;
  using P = WallsPlan;
  outcome.figure.title = "Walls for any arm, with the stiffness that `limpid analyze` computes";
  outcome.figure.caption = fmt::format(
      "Predictive coupling, eta = 1. There are {} random arms of 1 to {} joints and {} to {} kg, "
      "each in a different pose. The tip taps a wall at {} m/s along the direction in which the "
      "arm's dampers brake the tip least. Then the hand presses with {} N, or with half of the "
      "motors' limit if that is smaller. Desktop devices are held in grips of {} and {} N/m, arms "
      "of {} kg or more in grips of {} and {} N/m; the worse grip is drawn. The rms force allowed "
      "above {} Hz is {} times the pressing force, and {} N for robots. Points outside a frame are "
      "drawn at the frame's edge.",
      P::kArms, P::kMostJoints, P::kLightest, P::kHeaviest, WallTap::kSpeed, P::kPress,
      P::kDesktopGrips[0].stiffness, P::kDesktopGrips[1].stiffness, P::kRobot,
      P::kRobotGrips[0].stiffness, P::kRobotGrips[1].stiffness, WallTap::kFast, P::kRattle,
      P::kRobotRattle);
  outcome.figure.columns = 2;
  outcome.figure.panels = draw(felts);
  judge(felts, outcome.checks);
  return outcome;
}

}  // namespace limpid
