// A loop round a slide before a wall, for tests of the library.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "app/library/limpid/limpid.h"

namespace limpid::test {

// A slide along x [N, N s/m, kg], with a wall from x = 0 on [N/m].
inline LoopOptions slide_at_wall(double effort, double damping, double mass, double stiffness) {
  ArmModel arm;
  ArmJoint joint;
  joint.name = "slide";
  joint.slides = true;
  joint.axis = {1, 0, 0};
  joint.lower = -0.2;
  joint.upper = 0.2;
  joint.effort = effort;
  joint.damping = damping;
  joint.mass = mass;
  arm.joints = {joint};
  LoopOptions options;
  options.arm_text = urdf_text(arm);
  SceneBuilder scene;
  SurfaceMaterial wall;
  wall.stiffness = stiffness;
  options.scene_text = scene.plane("wall", {0, 0, 0}, {-1, 0, 0}, wall).text();
  return options;
}

inline LoopOptions slide() {
  LoopOptions options = slide_at_wall(8, 0.5, 0.1, 500);
  options.settings = {"coupling.kind=direct"};
  options.motors = Motors::simulated;
  return options;
}

// Ticks a loop at rest for so many seconds; returns the last torque of its first joint.
inline double rest(DeviceLoop& loop, std::span<const double> x, double seconds) {
  DeviceLoop::Reading reading;
  reading.position = x;
  reading.elapsed = 1e-3;
  double torque = 0;
  for (int k = 0; k < std::lround(1e3 * seconds); ++k) {
    // Somebody's hand is never quite still.
    std::vector<double> trembling(x.begin(), x.end());
    trembling[0] += k % 2 * 1e-6;
    reading.position = trembling;
    torque = loop.tick(reading)[0];
  }
  return torque;
}

// Arms a loop at a wall, until its force is on.
inline DeviceLoop armed() {
  LoopOptions options = slide();
  options.motors = Motors::real;
  const std::array<double, 1> x{0.004};
  DeviceLoop loop(options, x);
  loop.arm();
  EXPECT_LT(rest(loop, x, 1), -1);
  return loop;
}

inline std::string refusal(const std::function<void()>& of) {
  try {
    of();
  } catch (const LoopError& e) {
    return e.what();
  }
  return "nothing";
}

}  // namespace limpid::test
