// What a camera or a light can see of boxes.
#pragma once

#include <glm/glm.hpp>

#include "core/math/sizes.h"

namespace limpid {

// False only if the whole box, whose frame `to_clip` brings to clip space, lies beyond one side.
inline bool in_sight(const Eigen::AlignedBox3f& box, const glm::mat4& to_clip) {
  bool beyond[5] = {true, true, true, true, true};
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f c = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    const glm::vec4 p = to_clip * glm::vec4(c.x(), c.y(), c.z(), 1);
    beyond[0] &= p.x < -p.w;
    beyond[1] &= p.x > p.w;
    beyond[2] &= p.y < -p.w;
    beyond[3] &= p.y > p.w;
    beyond[4] &= p.z < -p.w;
  }
  return !(beyond[0] || beyond[1] || beyond[2] || beyond[3] || beyond[4]);
}

// Of the view, what a box covers at most; more than 1 where it reaches beyond it.
inline float share_of_view(const Eigen::AlignedBox3f& box, const glm::mat4& to_clip) {
  Eigen::AlignedBox2f covered;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f c = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    const glm::vec4 p = to_clip * glm::vec4(c.x(), c.y(), c.z(), 1);
    if (!(p.w > 1e-4f)) return 1e9f;  // around the eye
    covered.extend(Eigen::Vector2f(p.x / p.w, p.y / p.w));
  }
  return 0.25f * covered.sizes().prod();
}

}  // namespace limpid
