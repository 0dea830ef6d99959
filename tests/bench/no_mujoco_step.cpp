#include "tests/bench/mujoco_step.h"

namespace limpid::bench {

std::optional<Samples> mujoco_steps(const ArmDescription&, const Scene&, const Eigen::VectorXd&,
                                    int) {
  return std::nullopt;
}

}  // namespace limpid::bench
