#include "app/sweep/theory.h"

#include "app/run/analysis.h"
#include "app/run/grip_limit.h"

namespace limpid {

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

}  // namespace limpid
