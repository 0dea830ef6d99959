#include "app/desktop/base/passivity_break.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/run/analysis.h"
#include "app/run/lane_settings.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kStiffGrip = 3000;   // [N/m]
constexpr double kBelowLimit = 0.75;  // part of Routh's limit: energy grows within a second

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
  LaneParameters& all = settings.lanes.parameters;
  const std::size_t lane = settings.lanes.edited;
  settings.before_break = {all, lane};
  all[lane] = without_passivity(all[lane], arm);
  // The hand is the same for all lanes, and the first one's settings hold it.
  all[kMainLane].hand_stiffness = all[lane].hand_stiffness;
  all[kMainLane].hand_damping = all[lane].hand_damping;
  share_world(all);
}

void end_passivity_break(Settings& settings) {
  const auto before = std::exchange(settings.before_break, std::nullopt);
  if (!before) return;
  settings.lanes.parameters = before->parameters;
}

bool end_break_by_law(Settings& settings) {
  if (!passivity_broken(settings)) return false;
  const std::size_t lane = settings.before_break->lane;
  const CouplingKind chosen = settings.lanes.parameters[lane].kind;
  if (chosen == CouplingKind::proposed) return false;
  end_passivity_break(settings);
  settings.lanes.parameters[lane].kind = chosen;
  return true;
}

}  // namespace limpid
