#include "app/desktop/panels/passivity_break.h"

#include <algorithm>
#include <cmath>

#include "app/run/analysis.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

constexpr double kStiffGrip = 3000;   // [N/m]
constexpr double kBelowLimit = 0.75;  // of Routh's limit: energy grows within a second

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

PassivityBreak::Grip PassivityBreak::grip_of(const Parameters& p) {
  return {p.kind, p.eta, p.hand_stiffness, p.hand_damping};
}

bool PassivityBreak::broken(const Parameters& p) const { return made_ == grip_of(p); }

void PassivityBreak::break_it(Parameters& p, const ArmDescription& arm) {
  before_ = grip_of(p);
  p = without_passivity(p, arm);
  made_ = grip_of(p);
}

void PassivityBreak::repair(Parameters& p) {
  p.kind = before_->kind;
  p.eta = before_->eta;
  p.hand_stiffness = before_->stiffness;
  p.hand_damping = before_->damping;
}

}  // namespace limpid
