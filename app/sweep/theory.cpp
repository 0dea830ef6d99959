#include "app/sweep/theory.h"

#include <algorithm>
#include <cmath>

#include "app/run/analysis.h"
#include "app/run/grip_limit.h"
#include "app/sweep/axis_cells.h"

namespace limpid {
namespace {

constexpr int kTheoryPoints = 80;
constexpr const char* kTheoryInk[] = {kNeutralInk, kHandInk, kEnergyInk};

}  // namespace

std::string theory_label(const std::string& line) {
  if (line == "pr") return "PR (25)";
  return line == "routh" ? "Routh, locked" : "Routh, proxy on its spring";
}

double eta_limit(const std::string& line, const RunPlan& run) {
  const Parameters& p = run.parameters;
  const Eigen::VectorXd x = rest_at(run.arm, run.hand.position.front()).x1;
  if (line == "pr") return analyze(run.arm, x, p, std::nullopt).eta_min;
  if (line == "routh") return analyze(run.arm, x, p, std::nullopt).eta_min_grip;
  const ArmAt arm = arm_at(run.arm, x);
  return eta_min_compliant((1 + p.inertia_ratio) * arm.M, device_damping(run.arm, p), p,
                           p.hand_stiffness * arm.J.transpose() * arm.J);
}

Series theory_line(const SweepPlan& plan, std::uint64_t point, const SweepAxis& x,
                   const std::string& line) {
  const auto which = std::ranges::find(kTheories, line) - std::begin(kTheories);
  Series series{theory_label(line),
                kTheoryInk[which],
                which == 0 ? Series::Style::dashed : Series::Style::line,
                {}};
  const auto* key = find_parameter(x.key);
  const auto [from, to] = AxisCells(x).all();
  RunPlan run = run_of(plan, point);
  for (int i = 0; i <= kTheoryPoints; ++i) {
    const double part = static_cast<double>(i) / kTheoryPoints;
    const double at = x.logarithmic ? from * std::pow(to / from, part) : from + (to - from) * part;
    if (key != nullptr) set_parameter_number(run.parameters, *key, at);
    series.points.push_back({at, eta_limit(line, run)});
  }
  return series;
}

}  // namespace limpid
