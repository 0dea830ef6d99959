#include "app/experiments/experiment_arm.h"

#include <Eigen/Core>

#include "app/base/folders.h"
#include "app/run/fitted_gains.h"
#include "core/dynamics/arm.h"
#include "devices/files/urdf_file.h"

namespace limpid {

std::string ExperimentArm::heading() const { return built_in() ? "Built-in arm" : "Arm " + name; }

std::string ExperimentArm::gains() const {
  const std::string own = fit_text(settings);
  return own.empty() ? "paper's gains" : "gains " + own;
}

ExperimentArm built_in_arm() {
  ExperimentArm on{read_urdf(default_device()), {}};
  on.settings = fitted(on.description);
  on.settings.per_joint = false;  // closed forms are for gains of all joints alike
  return on;
}

ExperimentArm experiment_arm(const ArmDescription& arm, bool readings) {
  ExperimentArm on = built_in_arm();
  const bool built_in = arm.urdf == on.description.urdf;
  on.description = arm;
  if (built_in && !readings) return on;
  on.name = arm.name + (readings ? " with its readings" : "");
  on.readings = readings;
  on.settings = readings ? fitted_with_readings(arm) : fitted(arm);
  return on;
}

bool moves_as_built_in(const ArmDescription& arm) {
  constexpr double kSame = 1e-6;  // [m]
  const ArmDescription built_in = read_urdf(default_device());
  if (arm.dof() != built_in.dof()) return false;
  const Arm<kAnyDof> one(arm), other(built_in);
  // Each joint is turned by itself, then all together.
  for (int turned = 0; turned <= arm.dof(); ++turned) {
    Eigen::VectorXd x = rest_pose(built_in);
    for (int i = 0; i < arm.dof(); ++i) {
      const auto joint = static_cast<std::size_t>(i);
      if (arm.joints[joint].name != built_in.joints[joint].name) return false;
      if (turned == i || turned == arm.dof()) x[i] += 0.2;
    }
    if ((one.tip_at(x) - other.tip_at(x)).norm() > kSame) return false;
  }
  return true;
}

}  // namespace limpid
