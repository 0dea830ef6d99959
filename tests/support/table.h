// A table in reach of the arm that is built in.
#pragma once

#include "core/touch/scene.h"

namespace limpid::test {

inline const Vec3 kTable(0.2, 0, -0.04);  // on its top [m]

inline Scene table(const Material& material) {
  Scene scene;
  scene.add({"", pose_at(kTable), Plane{Vec3::UnitZ()}, material});
  return scene;
}

}  // namespace limpid::test
