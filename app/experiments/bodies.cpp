// Motion of bodies against closed forms: how far it is off, to both sides.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/body_bench.h"
#include "app/experiments/signals.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {
namespace {

constexpr double kBodyTicks[] = {1e-3, 2.5e-4};  // [s]

// Findings of all cases, tick by tick.
struct AllFindings {
  std::vector<BodyClaim> claims[std::size(kBodyTicks)];
  std::vector<Series> curves[std::size(kBodyTicks)];
};

AllFindings find_all(TrialRunner& lab) {
  std::vector<BodyCase> cases = cases_with_contacts();
  const std::vector<BodyCase> more = cases_with_joints();
  cases.insert(cases.end(), more.begin(), more.end());
  constexpr std::size_t kEach = std::size(kBodyTicks);
  std::vector<BodyFindings> found(kEach * cases.size());
  lab.each(found.size(), [&](std::size_t i) {
    if (lab.stopped()) throw Cancelled();
    found[i] = cases[i / kEach].find(kBodyTicks[i % kEach]);
  });
  AllFindings all;
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::ranges::move(found[i].claims, std::back_inserter(all.claims[i % kEach]));
    std::ranges::move(found[i].curves, std::back_inserter(all.curves[i % kEach]));
  }
  return all;
}

// A ball that rolls, out of the arm's reach.
SceneDocument rolling_ball() {
  SceneDocument document;
  document.title = "Ball on a slope";
  document.about = "A ball rolls down a slope of ten degrees.";
  const double slope = radians(10);
  const Vec3 foot(1, 0, 0), up(std::sin(slope), 0, std::cos(slope));
  Object plane = ground(slope, 0.9);
  plane.pose = pose_at(foot);
  document.scene.add(plane);
  document.scene.add(moving("ball", Sphere{0.02}, 0.05, pose_at(foot + 0.02 * up)));
  return document;
}

// Bodies by themselves beside the same ones in the ordinary loop, with an arm [m].
std::vector<Check> same_as_in_the_loop(TrialRunner& lab) {
  constexpr double kSeconds = 1;
  std::vector<Trial> trials;
  for (const double tick : kBodyTicks) {
    Parameters p;
    p.tick = tick;
    const HandPath hand =
        hand_path("stays", tick, kSeconds, [](double) { return Vec3(0.18, 0, 0); });
    RunPlan plan = plan_in(lab.arm().description, "title = \"\"\nabout = \"\"\n", hand, p);
    plan.document = rolling_ball();
    plan.document.toml = scene_text(plan.document, plan.arm);
    trials.push_back({fmt::format("rolling-ball-{:.4g}-ms", 1e3 * tick), plan});
  }
  std::vector<Check> checks;
  const std::vector<TrialResult> results = lab.run(trials);
  for (std::size_t i = 0; i < results.size(); ++i) {
    BodyBench bench(rolling_ball().scene, kBodyTicks[i]);
    const Session& s = results[i].session;
    double off = 0;
    for (std::size_t k = 0; k < s.size(); ++k) {
      const auto pose = s.at(k, Column::body_pose);
      off = worse(off, (Vec3(pose[0], pose[1], pose[2]) - bench.world().center(0)).norm());
      bench.step();
    }
    checks.push_back(at_most(
        fmt::format(
            "ball in a scene with an arm: distance from the ball simulated without an arm, {} [m]",
            tick_text(kBodyTicks[i])),
        off, 1e-9));
  }
  return checks;
}

// Error over limit of every claim, those of one kind in a column.
FigurePanel errors_panel(const std::vector<BodyClaim>& claims, double tick) {
  FigurePanel panel{.title = "Errors divided by their limits, " + tick_text(tick),
                    .x_label = "kind of motion",
                    .y_label = "error / limit [-]",
                    .log_y = true,
                    .y_range = std::pair(1e-4, 1e4)};
  Series more{"above theory", kContactInk, Series::Style::points, {}};
  Series less{"below theory", kProxyInk, Series::Style::points, {}};
  std::vector<std::string> groups;
  for (const BodyClaim& claim : claims) {
    if (claim.group.empty()) continue;
    if (std::ranges::find(groups, claim.group) == groups.end()) groups.push_back(claim.group);
    const auto of_group = [&](const BodyClaim& one) { return one.group == claim.group; };
    const auto place = std::ranges::find(groups, claim.group) - groups.begin();
    const auto many = std::ranges::count_if(claims, of_group);
    const auto before = std::count_if(claims.data(), &claim, of_group);
    const double x = static_cast<double>(place) +
                     0.8 * ((static_cast<double>(before) + 0.5) / static_cast<double>(many) - 0.5);
    const double by = std::clamp(std::abs(claim.error()) / claim.limit, 1.2e-4, 0.8e4);
    (claim.error() > 0 ? more : less).points.push_back({x, by});
  }
  for (std::size_t i = 0; i < groups.size(); ++i) {
    panel.x_ticks.emplace_back(static_cast<double>(i), groups[i]);
  }
  const double end = static_cast<double>(groups.size()) - 0.5;
  panel.x_range = std::pair(-0.5, end);
  panel.series = {Series{"limit", kHandInk, Series::Style::dashed, {{-0.5, 1}, {end, 1}}}, more,
                  less};
  return panel;
}

// The curves whose label begins like this, or that follow one of them without a label.
std::vector<Series> curves_of(const std::vector<Series>& curves, std::string_view begin) {
  std::vector<Series> some;
  bool within = false;
  for (const Series& curve : curves) {
    if (!curve.label.empty()) within = curve.label.starts_with(begin);
    if (within) some.push_back(curve);
  }
  return some;
}

}  // namespace

Outcome bodies(TrialRunner& lab) {
  Outcome outcome;
  const AllFindings all = find_all(lab);
  for (const auto& claims : all.claims) {
    for (const BodyClaim& claim : claims) outcome.checks.push_back(claim.check());
  }
  for (const Check& check : same_as_in_the_loop(lab)) outcome.checks.push_back(check);
  outcome.figure.title = "Motion of bodies, compared with closed-form solutions";
  outcome.figure.columns = 2;
  FigurePanel swing{.title = "Energy of a pendulum during one minute, " + tick_text(kBodyTicks[0]),
                    .x_label = "time [s]",
                    .y_label = "energy minus energy at the start [mJ]",
                    .series = curves_of(all.curves[0], "swings")};
  FigurePanel roll{.title = "Rolling down a slope of 20 degrees, " + tick_text(kBodyTicks[0]),
                   .x_label = "time [s]",
                   .y_label = "distance [m]"};
  for (const char* name : {"ball", "cylinder", "capsule"}) {
    for (const Series& curve : curves_of(all.curves[0], name)) roll.series.push_back(curve);
  }
  outcome.figure.panels = {errors_panel(all.claims[0], kBodyTicks[0]),
                           errors_panel(all.claims[1], kBodyTicks[1]), swing, roll};
  outcome.figure.caption =
      "Bodies without an arm, simulated in the same ticks as in the loop. The first row shows the "
      "error of each check divided by the limit of the check, for two lengths of the tick. Errors "
      "outside the range of the axis are drawn at its end. In the panel on rolling, solid curves "
      "are simulated and dashed curves are theory.";
  return outcome;
}

}  // namespace limpid
