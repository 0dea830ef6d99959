// Stacks of blocks under the tip: how far they sink, iterations over their contacts in a tick, and
// that they make no energy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/moving.h"

namespace limpid {
namespace {

constexpr double kStackEdge = 0.03, kStackTip = 0.004, kStackGravity = 9.81;  // [m, m, m/s^2]
constexpr double kStackBetween = 20000;                  // K_o of a contact point [N/m]
constexpr int kStackPoints = 4;                          // contact points of two blocks
constexpr double kBelow = kStackPoints * kStackBetween;  // of all points together [N/m]
constexpr double kStackPress = 1, kStackWall = 2000;     // [N, N/m]
constexpr double kStackTick = 0.001, kStackDown = 1, kStackSeconds = 3;  // [s]
constexpr double kStackAbove = 0.005;   // height of the tip at the start [m]
constexpr double kStackGrip = 300;      // [N/m]
constexpr double kStackMeasured = 0.9;  // just before the tip touches [s]

struct Stack {
  std::string name;  // of its session
  std::string label;
  const char* ink;
  std::vector<double> masses;  // from below [kg]

  double top() const {
    return kStackEdge * static_cast<double>(masses.size());
  }  // above the floor [m]
  // Force of the hand at the end: springs of hand, tip and all contacts in series; the contacts are
  // already pressed in by the weight [N].
  double force() const {
    constexpr double kGive = 1 / kStackGrip + 1 / kStackWall;
    double sunk = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) sunk += weight_on(i) / kBelow;
    return (kStackPress * kGive - sunk) / (kGive + static_cast<double>(masses.size()) / kBelow);
  }
  // Weight on the contacts below a block [N].
  double weight_on(std::size_t block) const {
    double sum = 0;
    for (std::size_t i = block; i < masses.size(); ++i) sum += kStackGravity * masses[i];
    return sum;
  }
};

std::vector<Stack> stacks() {
  return {{"five", "5 of 20 g", kFamilyInk[0], std::vector<double>(5, 0.02)},
          {"heavy-below", "500, 50, 5 g from below", kFamilyInk[2], {0.5, 0.05, 0.005}},
          {"heavy-above", "5, 50, 500 g from below", kFamilyInk[1], {0.005, 0.05, 0.5}},
          {"hundred-times", "5, 500 g from below", kFamilyInk[3], {0.005, 0.5}}};
}

// Height of the floor that brings the top of the stack within reach [m].
double floor_of(const Stack& stack) { return -0.02 - stack.top(); }

Trial stack_pressed(const ExperimentArm& on, const Stack& stack) {
  std::vector<BoxText> boxes;
  for (std::size_t i = 0; i < stack.masses.size(); ++i) {
    boxes.push_back(
        {.name = fmt::format("block {}", i + 1),
         .size = Vec3::Constant(kStackEdge),
         .mass = stack.masses[i],
         .at = Vec3(0.2, 0, floor_of(stack) + kStackEdge * (static_cast<double>(i) + 0.5)),
         .stiffness = kStackWall,
         .friction = 0.5});
  }
  const std::string before = fmt::format(
      "gravity = [0, 0, {}]\ntip_radius = {}\n\n[[plane]]\nname = \"floor\"\npoint = [0.2, 0, "
      "{:.9g}]\nnormal = [0, 0, 1]\nstiffness = {}\n",
      -kStackGravity, kStackTip, floor_of(stack), kStackWall);
  Parameters p = on.settings;
  p.kind = CouplingKind::predictive;
  p.hand_stiffness = kStackGrip;
  const double above = floor_of(stack) + stack.top() + kStackTip + kStackAbove;
  const double way = kStackAbove + kStackPress / kStackGrip + kStackPress / kStackWall;
  const auto at = [=](double t) {
    return Vec3(0.2, 0, above - way * minimum_jerk((t - kStackDown) / 0.5));
  };
  const std::string source = fmt::format("presses with {} N on a stack that ends at {:.6g} m",
                                         kStackPress, floor_of(stack) + stack.top());
  return {stack.name, plan_in(on.description, scene_of(boxes, before),
                              hand_path(source, kStackTick, kStackSeconds, at), p)};
}

// Depth of each contact before the tip arrives, from the floor up [m].
std::vector<double> pressed_in(const Stack& stack, const Session& s) {
  const auto row = static_cast<std::size_t>(kStackMeasured / kStackTick);
  const auto pose = s.at(row, Column::body_pose);
  std::vector<double> depths;
  double below = floor_of(stack) - kStackEdge / 2;
  for (std::size_t i = 0; i < stack.masses.size(); ++i) {
    const double at = pose[kPoseNumbers * i + 2];
    depths.push_back(kStackEdge - (at - below));
    below = at;
  }
  return depths;
}

}  // namespace

Outcome stack(TrialRunner& lab) {
  const std::vector<Stack> all = stacks();
  std::vector<Trial> trials;
  trials.reserve(all.size());
  for (const Stack& one : all) trials.push_back(stack_pressed(lab.arm(), one));
  const std::vector<TrialResult> results = lab.run(trials);

  FigurePanel sinks{.title = "Depth of contacts under the weight above",
                    .x_label = "weight above a contact [N]",
                    .y_label = "depth [mm]",
                    .log_x = true,
                    .log_y = true};
  FigurePanel sweeps{.title = "Solver iterations until a tick's contact forces were found",
                     .x_label = "time [s]",
                     .y_label = "iterations [-]",
                     .x_range = std::pair(0.0, kStackSeconds)};
  FigurePanel gain{.title = "Energy gained by the stack, minus energy given to the stack",
                   .x_label = "time [s]",
                   .y_label = "energy [mJ]",
                   .x_range = std::pair(0.0, kStackSeconds)};
  FigurePanel force{.title = "Force of the top block on the tip",
                    .x_label = "time [s]",
                    .y_label = "force [N]",
                    .x_range = std::pair(kStackDown, kStackSeconds)};
  Outcome outcome;
  Series theory{
      fmt::format("weight / ({} K_o)", kStackPoints), kHandInk, Series::Style::dashed, {}};
  for (double W = 0.04; W < 7; W *= 1.2) theory.points.push_back({W, 1e3 * W / kBelow});
  sinks.series.push_back(theory);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Stack& one = all[i];
    const Session& s = results[i].session;
    const std::vector<double> depths = pressed_in(one, s);
    Series dots{one.label, one.ink, Series::Style::points, {}};
    double off = 0;
    for (std::size_t block = 0; block < depths.size(); ++block) {
      const double W = one.weight_on(block);
      dots.points.push_back({W, 1e3 * depths[block]});
      off = worse(off, std::abs(depths[block] - W / kBelow));
    }
    sinks.series.push_back(dots);
    sweeps.series.push_back(over_time(s, one.label, one.ink, Series::Style::line,
                                      [&](auto k) { return s.at(k, Column::objects_sweeps)[0]; }));
    gain.series.push_back(over_time(s, one.label, one.ink, Series::Style::line, [&](auto k) {
      return 1e3 * s.at(k, Column::objects_gain)[0];
    }));
    force.series.push_back(over_time(s, one.label, one.ink, Series::Style::line,
                                     [&](auto k) { return s.at(k, Column::contact_force)[2]; }));
    const MovingVerdict v = judge_moving(results[i]);
    const std::string which = one.label + ": ";
    outcome.checks.push_back(
        at_most(which + "deviation of a contact's depth from weight / (4 K_o) [m]", off, 2e-5));
    outcome.checks.push_back(at_most(which + "energy gained by the blocks [J]", v.gain, 1e-6));
    outcome.checks.push_back(at_most(which + "highest E_c [J]", v.energy, 5e-5));
    outcome.checks.push_back(
        at_most(which + "largest energy given to the human minus the energy of the blocks [J]",
                v.beyond, 5e-5));
    outcome.checks.push_back(
        at_most(which + "number of ticks without a solution, in which the proxy did not move",
                v.unsolved, 0));
    const double last = s.at(s.size() - 1, Column::contact_force)[2];
    outcome.checks.push_back(at_most(
        which + "relative deviation of the final force from the force of all springs in series",
        std::abs(last / one.force() - 1), 0.02));
  }
  outcome.figure.title = "Stacks of blocks, with the tip on top";
  outcome.figure.columns = 2;
  outcome.figure.panels = {sinks, sweeps, gain, force};
  outcome.figure.caption = fmt::format(
      "Blocks of {} mm stand on a floor; the coupling is the predictive one. The tip presses from "
      "above with {} N after {} s. Friction is 0.5. Contacts among blocks have K_o = {} N/m at "
      "each of {} points; the tip's contact has {} N/m. The first panel shows the depths just "
      "before the tip arrives. The part of a depth above the line existed when the contact was "
      "found; it gives no force. In an iteration the solver treats each contact once. Its "
      "iterations for the tip's contacts and for all other contacts are added. A stack at rest "
      "sleeps, and needs no iterations.",
      1e3 * kStackEdge, kStackPress, kStackDown, kStackBetween, kStackPoints, kStackWall);
  return outcome;
}

}  // namespace limpid
