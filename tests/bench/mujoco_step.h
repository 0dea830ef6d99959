// MuJoCo's step of the same arm on the same plane, for comparison.
#pragma once

#include <optional>

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"
#include "tests/bench/bench.h"

namespace limpid::bench {

// Times `steps` steps of 1 ms from posture x, the tip pulled down with 1 N. Returns nothing if the
// benchmark was built without MuJoCo.
std::optional<Samples> mujoco_steps(const ArmDescription& arm, const Scene& scene,
                                    const Eigen::VectorXd& x, int steps);

}  // namespace limpid::bench
