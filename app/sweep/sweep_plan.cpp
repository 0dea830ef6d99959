#include "app/sweep/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/urdf_writer.h"
#include "app/run/varied_hand.h"
#include "app/run/wall_tap.h"
#include "app/sweep/body_axis.h"
#include "core/dynamics/random.h"
#include "core/dynamics/random_arm.h"
#include "devices/files/config_file.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

// Choices of the axes for a run: parameters, scene, arm, and the world of a case.
struct Chosen {
  SweepWorld world;
  Parameters parameters;
  std::optional<double> stiffness = {};
  std::optional<double> joints = {}, mass = {}, seed = {};  // of a random arm
  std::vector<std::pair<BodyAxis, double>> of_bodies = {};

  bool random_arm() const { return joints || mass || seed; }
  void take(const SweepAxis& axis, double value) {
    if (axis.key == kStiffnessKey) {
      stiffness = value;
    } else if (axis.key == kArmJointsKey) {
      joints = value;
    } else if (axis.key == kArmMassKey) {
      mass = value;
    } else if (axis.key == kArmSeedKey) {
      seed = value;
    } else if (auto of_body = body_axis(axis.key)) {
      of_bodies.emplace_back(std::move(*of_body), value);
    } else if (!axis.key.empty()) {
      set_parameter_number(parameters, *find_parameter(axis.key), value);
    } else {
      const SweepCase& one = axis.cases[static_cast<std::size_t>(value)];
      for (const std::string& setting : one.settings) apply_setting(parameters, setting);
      world = world.with(one.world);
    }
  }
};

// Returns the choices of a point for settings that begin as `base`.
Chosen chosen_of(const SweepPlan& plan, const SweepPoint& point, std::optional<double> at,
                 const Parameters& base) {
  Chosen chosen{plan.world, base};
  for (const std::string& setting : plan.settings) apply_setting(chosen.parameters, setting);
  for (std::size_t a = 0; a < plan.axes.size(); ++a) chosen.take(plan.axes[a], point.values[a]);
  if (at) chosen.take(plan.boundary->axis, *at);
  return chosen;
}

// An arm in a pose.
struct PosedArm {
  ArmDescription arm;
  Eigen::VectorXd x;
};

// A random arm as its own URDF: a session contains that file, so it can be repeated.
PosedArm random_one(const Chosen& chosen) {
  constexpr double kDesktopLink = 0.05;  // [kg]
  const int joints = static_cast<int>(chosen.joints.value_or(3));
  const auto seed = static_cast<unsigned>(chosen.seed.value_or(0));
  const double mass = chosen.mass.value_or(kDesktopLink * joints);
  const std::string text =
      urdf_text(weighing(random_arm(joints, seed), mass),
                fmt::format("random arm: {} joints, {} kg, seed {}", joints, mass, seed));
  return {parse_urdf(text, "random arm", {}), Random(seed + 1000).vector(joints, 0.6)};
}

// A run that taps a wall, as stiff as an axis says or as tip_limits() names it.
RunPlan tapping(const SweepPlan& plan, const Chosen& chosen, const PosedArm& posed) {
  constexpr double kSoftest = 1;  // if no wall is named [N/m]
  const Parameters& p = chosen.parameters;
  const TapPlace place = tap_place(posed.arm, posed.x, p);
  WallTap tap;
  tap.press = bearable_press(posed.arm, place, p, *plan.tap);
  tap.hold = plan.seconds > 0 ? plan.seconds : 1;
  const TipLimits limits = tip_limits(posed.arm, posed.x, p, {});
  tap.wall = chosen.stiffness.value_or(std::max(kSoftest, limits.wall(p.kind).stiffness));
  RunPlan run = tap_plan(posed.arm, place, tap, p);
  run.seed = plan.seed;
  return run;
}

}  // namespace

SweepWorld SweepWorld::with(const SweepWorld& chosen) const {
  const auto either = [](const std::string& now, const std::string& said) {
    return said.empty() ? now : said;
  };
  return {either(device, chosen.device), either(scene, chosen.scene), either(hand, chosen.hand)};
}

bool SweepLimit::met(double value) const {
  if (!above && !below) return value == 1;
  return (!above || value > *above) && (!below || value < *below);
}

std::uint64_t SweepPlan::points() const {
  std::uint64_t count = samples * repeats;
  for (const SweepAxis& axis : axes) {
    if (axis.spread == Spread::grid) count *= axis.values.size();
  }
  return count;
}

SweepPoint point_of(const SweepPlan& plan, std::uint64_t index) {
  SweepPoint point;
  const auto next = [&index](std::uint64_t of) {
    const std::uint64_t digit = index % of;
    index /= of;
    return digit;
  };
  point.repeat = next(plan.repeats);
  const std::uint64_t sample = next(plan.samples);
  point.place.resize(plan.axes.size());
  for (std::size_t a = plan.axes.size(); a-- > 0;) {
    const SweepAxis& axis = plan.axes[a];
    point.place[a] = axis.spread == Spread::grid ? next(axis.values.size()) : sample;
  }
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    point.values.push_back(plan.axes[a].values[point.place[a]]);
  }
  return point;
}

std::uint64_t number_of(const SweepPlan& plan, const std::vector<std::size_t>& place,
                        std::uint64_t sample, std::uint64_t repeat) {
  std::uint64_t number = 0;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    if (axis.spread == Spread::grid) number = number * axis.values.size() + place[a];
  }
  return (number * plan.samples + sample) * plan.repeats + repeat;
}

RunPlan run_of(const SweepPlan& plan, std::uint64_t index, std::optional<double> at) {
  const SweepPoint point = point_of(plan, index);
  const Chosen asked = chosen_of(plan, point, at, {});
  const RunPlan& world = *plan.worlds.at(asked.world);
  PosedArm posed{world.arm, {}};
  if (asked.random_arm()) posed = random_one(asked);
  // Gains fit the arm where the plan does not say them.
  const Chosen chosen = chosen_of(plan, point, at, fitted(posed.arm, asked.parameters));
  if (plan.tap) {
    if (!chosen.random_arm()) posed.x = rest_pose(posed.arm);
    return tapping(plan, chosen, posed);
  }
  RunPlan run = world;
  run.parameters = chosen.parameters;
  run.seed = plan.seed;
  if (chosen.stiffness) set_surface_stiffness(run.document.scene, *chosen.stiffness);
  for (const auto& [of_body, value] : chosen.of_bodies) {
    set_of_body(of_body, value, run.document);
  }
  if (plan.jump) run.hand.time.back() = run.parameters.tick;
  if (point.repeat > 0) run.hand = varied(run.hand, plan.seed, point.repeat);
  const double seconds = plan.seconds > 0 ? plan.seconds : run.hand.duration();
  run.rows = static_cast<std::uint64_t>(std::max(1LL, std::llround(seconds / run.parameters.tick)));
  return run;
}

}  // namespace limpid
