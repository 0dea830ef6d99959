// The hand that holds a simulated device.
#pragma once

#include <span>

#include "core/math/sizes.h"

namespace limpid {

// What it does over a tick: it goes on from where it wanted the tip a tick ago to `target`.
struct HandInput {
  Vec3 target = Vec3::Zero();        // [m]
  double grip = 1;                   // 1 holds, 0 has let go; scales stiffness and damping
  std::span<const double> torque{};  // pushed on the joints besides [N m]; empty: none
};

}  // namespace limpid
