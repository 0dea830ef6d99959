#include "app/desktop/base/passivity_break.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/analysis.h"
#include "app/run/twin_settings.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kStiffGrip = 3000;   // [N/m]
constexpr double kBelowLimit = 0.75;  // part of Routh's limit: energy grows within a second

Parameters& run_of(Settings& settings, bool twin) {
  return twin ? settings.twin.parameters : settings.parameters;
}

}  // namespace

Parameters without_passivity(const Parameters& p, const ArmDescription& arm) {
  Parameters broken = p;
  broken.kind = CouplingKind::proposed;
  broken.hand_stiffness = kStiffGrip;
  broken.hand_damping = 0;
  const double limit = analyze(arm, rest_pose(arm), broken, std::nullopt).eta_min_grip;
  const ParameterInfo& eta = *find_parameter("coupling.eta");
  broken.eta = std::max(std::round(100 * kBelowLimit * limit) / 100, eta.slider_minimum);
  return broken;
}

void break_passivity(Settings& settings, const ArmDescription& arm) {
  if (passivity_broken(settings)) return;
  const bool twin = settings.twin.on && settings.twin.edited;
  settings.before_break = {settings.parameters, settings.twin.parameters, twin};
  Parameters& run = run_of(settings, twin);
  run = without_passivity(run, arm);
  // The hand is the same for both runs, and the first run's settings hold it.
  settings.parameters.hand_stiffness = run.hand_stiffness;
  settings.parameters.hand_damping = run.hand_damping;
  share_world(settings.parameters, settings.twin.parameters);
}

void end_passivity_break(Settings& settings) {
  const auto before = std::exchange(settings.before_break, std::nullopt);
  if (!before) return;
  settings.parameters = before->first;
  settings.twin.parameters = before->twin;
}

bool end_break_by_law(Settings& settings) {
  if (!passivity_broken(settings)) return false;
  const bool twin = settings.before_break->of_twin;
  const CouplingKind chosen = run_of(settings, twin).kind;
  if (chosen == CouplingKind::proposed) return false;
  end_passivity_break(settings);
  run_of(settings, twin).kind = chosen;
  return true;
}

}  // namespace limpid
