// The one place where Eigen's types become GLM's.
#pragma once

#include <glm/glm.hpp>

#include "core/math/sizes.h"

namespace limpid {

inline glm::vec3 to_glm(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

inline glm::mat4 to_glm(const Eigen::Matrix4d& m) {
  glm::mat4 out;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) out[column][row] = static_cast<float>(m(row, column));
  return out;
}

inline glm::mat4 to_glm(const Pose& pose) { return to_glm(Eigen::Matrix4d(pose.matrix())); }

}  // namespace limpid
