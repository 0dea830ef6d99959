#include "app/experiments/law_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/folders.h"
#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "core/math/high_pass.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

constexpr int kQuietHalvings = 7;  // of the search, in its logarithm
constexpr double kDirectLeast = 0.85, kDirectMost = 1.25;

// Finds the force on the hand in the last part of a tap, from its own torque.
Came came_of(const RunPlan& plan, const TapPlace& place, const WallTap& tap,
             const TrialResult& result) {
  if (result.end.diverged) return {HUGE_VAL, HUGE_VAL, 0, HUGE_VAL};
  const Session& s = result.session;
  const double T = s.info.tick;
  const Arm<kAnyDof> arm(plan.arm);
  const auto judged = static_cast<std::size_t>(tap.judged / T);
  HighPass fast[] = {{WallTap::kFast, 1 / T}, {WallTap::kFast, 1 / T}, {WallTap::kFast, 1 / T}};
  Came came;
  double force = 0, depth = 0, fast2 = 0;
  Vec3 before = arm.tip_at(vector_at(s, 0, Column::device_position));
  for (std::size_t k = 0; k < s.size(); ++k) {
    came.port = worse(came.port, s.at(k, Column::energy_port)[0]);
    came.total = worse(came.total, s.at(k, Column::energy_total)[0]);
    const Eigen::VectorXd x = vector_at(s, k, Column::device_position);
    const Vec3 tip = arm.tip_at(x);
    Vec3 v = (tip - before) / T;
    before = tip;
    for (int i = 0; i < 3; ++i) v[i] = fast[i](v[i]);
    if (k + judged < s.size()) continue;
    fast2 += v.squaredNorm();
    const Eigen::VectorXd hand = vector_at(s, k, Column::hand_torque);
    const Eigen::MatrixXd lever = arm_at(plan.arm, x).J.transpose();
    force -= place.out.dot(Vec3(least_squares(lever, hand)));
    depth += std::max(0.0, place.depth(tip));
  }
  came.chatter = std::sqrt(fast2 / static_cast<double>(judged));
  came.felt = depth > 0 ? force / depth / tap.wall : 0;
  return came;
}

}  // namespace

ArmDescription BenchArm::arm() const {
  ArmDescription arm = read_urdf(default_device().parent_path() / file);
  for (Link& link : arm.links) {
    link.mass *= heavier;
    link.inertia *= heavier;
  }
  arm.encoder_step = step.value_or(arm.encoder_step);
  arm.assumed_delay = late.value_or(arm.assumed_delay);
  return arm;
}

const BenchLaw& bench_law(CouplingKind kind) {
  return *std::ranges::find(kBenchLaws, kind, &BenchLaw::kind);
}

std::vector<Came> tap_arms(TrialRunner& lab, const std::vector<ArmTap>& taps) {
  std::vector<Trial> trials;
  std::vector<TapPlace> places;
  std::vector<WallTap> ways;
  for (const ArmTap& tap : taps) {
    const auto& [arm, p] = tap.at;
    places.push_back(tap_place(arm, rest_pose(arm), p));
    ways.push_back({.wall = tap.wall,
                    .press = bearable_press(arm, places.back(), p, kHardest),
                    .hold = tap.hold});
    trials.push_back({"", tap_plan(arm, places.back(), ways.back(), p)});
    trials.back().keep = false;
    trials.back().may_diverge = true;
  }
  std::vector<Came> came(taps.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    came[i] = came_of(trials[i].plan, places[i], ways[i], result);
  });
  return came;
}

std::vector<double> stiffest_of(std::size_t count, const WallsJudge& judge) {
  std::vector<double> low(count, kLeastWall), high(count, kMostWall), middle(count);
  for (int step = 0; step < kQuietHalvings; ++step) {
    for (std::size_t i = 0; i < count; ++i) middle[i] = std::sqrt(low[i] * high[i]);
    const std::vector<bool> well = judge(middle);
    for (std::size_t i = 0; i < count; ++i) (well[i] ? low : high)[i] = middle[i];
  }
  return low;
}

std::vector<double> stiffest_quiet_walls(TrialRunner& lab, const std::vector<ArmUnderLaw>& all) {
  return stiffest_of(all.size(), [&](const std::vector<double>& walls) {
    std::vector<ArmTap> taps;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t h = 0; h < kDamped; ++h) {
        taps.push_back({all[i], walls[i]});
        kHands[h].holds(taps.back().at.parameters);
      }
    }
    const std::vector<Came> came = tap_arms(lab, taps);
    std::vector<bool> well;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto first = came.begin() + static_cast<std::ptrdiff_t>(kDamped * i);
      well.push_back(std::all_of(first, first + kDamped, [](const Came& c) { return c.well(); }));
    }
    return well;
  });
}

std::array<Check, 2> by_direct_theory(const std::string& what, double ratio) {
  return {at_least(what, ratio, kDirectLeast), at_most(what, ratio, kDirectMost)};
}

FigurePanel energy_panel(const std::string& title, std::span<const LawCame> all) {
  constexpr double kLeast = 1e-4, kMost = 1e3;  // [mJ]
  FigurePanel panel{.title = title,
                    .x_label = "stiffness felt [N/m]",
                    .y_label = "largest energy given to the hand [mJ]",
                    .log_x = true,
                    .log_y = true,
                    .x_range = std::pair(20.0, 4000.0),
                    .y_range = std::pair(0.5 * kLeast, 2 * kMost)};
  for (const BenchLaw& law : kBenchLaws) {
    Series points = law.points();
    for (const auto& [kind, came] : all) {
      if (kind != law.kind) continue;
      points.points.push_back({std::clamp(came.felt * kCommonWall, 20.0, 4000.0),
                               std::clamp(1e3 * came.port, kLeast, kMost)});
    }
    panel.series.push_back(points);
  }
  return panel;
}

}  // namespace limpid
