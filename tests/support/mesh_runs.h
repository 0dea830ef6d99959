// The built-in arm, led over meshes by the hand.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/meshes.h"
#include "tests/support/rows.h"

namespace limpid::test {

inline const Vec3 kHome(0.19, 0, 0);
inline constexpr double kTop = -0.04;      // top of what lies on the table [m]
inline constexpr double kTip = 0.004;      // radius [m]
using Path = std::function<Vec3(double)>;  // the hand's target for the tip at a time

inline Scene with_mesh(const Triangles& triangles, const Vec3& at, double stiffness = 600) {
  Scene scene;
  scene.tip_radius = kTip;
  scene.add(obstacle(triangles, stiffness));
  scene.objects.back().pose.translation() = at;
  return scene;
}

inline Rows run(const Scene& scene, const Parameters& p, const Path& path, double seconds) {
  const ArmDescription arm = omni();
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, path(0)));
  Rows rows(rig.layout());
  for (int k = 0; k < seconds / p.tick && !rig.diverged(); ++k) {
    rig.step(p, {{path(k * p.tick), 1}}, rows.add());
  }
  EXPECT_FALSE(rig.diverged());
  return rows;
}

// Path down from kHome to `height` in half a second, then along a figure of `width` there.
inline Path stroke(double height, double width) {
  return [=](double t) {
    const double s = std::min(1.0, 2 * t), smooth = s * s * (3 - 2 * s);
    const double u = std::max(0.0, t - 0.5);
    return Vec3(kHome.x() + width * std::sin(2.9 * u), width * std::sin(4.3 * u),
                kHome.z() + smooth * (height - kHome.z()));
  };
}

inline double largest(const Rows& rows, Column c) {
  double out = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) out = std::max(out, rows.vec(k, c).norm());
  return out;
}

// A landscape of hills 4 mm high and ripples.
inline Triangles landscape() {
  return height_field(150, 0.2, [](double x, double y) {
    return 0.002 * std::sin(120 * x) * std::cos(100 * y) + 2e-4 * std::sin(700 * x);
  });
}

}  // namespace limpid::test
