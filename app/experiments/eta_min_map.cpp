// Section 4.2, (22)-(25): stability of the loop over eta and the stiffness of the grip.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/base/folders.h"
#include "app/experiments/experiment.h"
#include "app/sweep/sweep_figure.h"
#include "app/sweep/sweep_map.h"

namespace limpid {
namespace {

constexpr double kUsualGrip = 3000;  // no hand is stiffer [N/m]
constexpr double kEtaStep = 0.05;    // of the plan's axis
enum Axis : std::size_t { kTicks, kGrip, kEta };
enum Ticks : std::size_t { kFine, kPaper };

// Largest distance of a map's point from a line of theory on its wrong side, in eta; infinite if
// none was compared.
double misplaced(const SweepPlan& plan, const SweepTable& table, Ticks ticks, double stiffest,
                 const std::string& line) {
  double worst = 0;
  int compared = 0;
  for (std::uint64_t i = 0; i < table.points(); ++i) {
    const SweepPoint point = point_of(plan, i);
    if (point.place[kTicks] != ticks || point.values[kGrip] > stiffest) continue;
    const double beyond = point.values[kEta] - eta_limit(line, run_of(plan, i));
    worst = worse(worst, table.at(i, 0) == 1 ? -beyond : beyond);
    ++compared;
  }
  return compared > 0 ? worst : HUGE_VAL;
}

// Puts an arm with its gains and its damping into all runs of a plan.
void put(const ExperimentArm& on, SweepPlan& plan) {
  static_cast<SpringDamper&>(plan.parameters) = on.settings;
  plan.parameters.alpha = on.settings.alpha;
  plan.parameters.damping = on.settings.damping;
  for (auto& [world, run] : plan.worlds) {
    RunPlan changed = *run;
    changed.arm = on.description;
    run = std::make_shared<const RunPlan>(std::move(changed));
  }
}

std::string caption(const ExperimentArm& on, const SweepPlan& plan) {
  RunPlan without_proxy = run_of(plan, 0);
  without_proxy.parameters.b_v = 0;
  return fmt::format(
      "{}, full nonlinear loop at the {}; the tip is {} m ahead. The hand jumps by {:.0f} um along "
      "each axis and then holds without damping. Stable means that the motion becomes small in {} "
      "s or less. A stiff grip oscillates above k_vc / b_v = {:.0f} rad/s. At such frequencies the "
      "coupling's spring moves instead of the proxy's damper. So the limit of eta rises from the "
      "value of equation (25) towards its value with b_d alone, {:.2f}. In such grips ticks of 1 "
      "ms differ from the continuous theory.",
      on.heading(), on.gains(), plan.jump->at.x(), 1e6 * plan.jump->by.x(), plan.seconds,
      on.settings.k_vc / on.settings.b_v, eta_limit("pr", without_proxy));
}

}  // namespace

Outcome eta_min_map(TrialRunner& lab) {
  SweepPlan plan = read_sweep_plan(data_dir() / "assets/sweeps/eta_min.toml");
  put(lab.arm(), plan);
  const SweepTable table = lab.sweep(plan);
  Outcome outcome;
  outcome.figure = sweep_figure(plan, table);
  outcome.figure.caption = caption(lab.arm(), plan);
  const std::string locked_text = fmt::format(
      "Routh's limit with device and proxy locked together, grips up to {} N/m", kUsualGrip);
  outcome.checks = {
      at_most("ticks of 0.1 ms: largest distance in eta of points on the wrong side of Routh's "
              "limit with the proxy on its spring, all grips",
              misplaced(plan, table, kFine, HUGE_VAL, "routh_compliant"), kEtaStep),
      at_most(
          "ticks of 0.1 ms: largest distance in eta of points on the wrong side of " + locked_text,
          misplaced(plan, table, kFine, kUsualGrip, "routh"), kEtaStep),
      at_most(
          "ticks of 1 ms: largest distance in eta of points on the wrong side of " + locked_text,
          misplaced(plan, table, kPaper, kUsualGrip, "routh"), kEtaStep)};
  return outcome;
}

}  // namespace limpid
