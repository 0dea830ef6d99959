// Bodies by themselves, without an arm, over ticks of a millisecond.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/touch/body_world.h"

namespace limpid::test {

inline constexpr double kTick = 1e-3;  // [s]

inline Object body(std::string name, Shape shape, double mass, const Vec3& at,
                   double friction = 0.5) {
  Object o;
  o.name = std::move(name);
  o.shape = std::move(shape);
  o.pose = pose_at(at);
  o.material = {2000, 0, friction, friction};
  o.body = Body{};
  o.body->mass = mass;
  return o;
}

inline Object floor_at(double z) {
  Object o;
  o.name = "floor";
  o.shape = Plane{};
  o.pose = pose_at({0, 0, z});
  return o;
}

inline Mat3 turned(double angle, const Vec3& about) {
  return Eigen::AngleAxisd(angle, about.normalized()).matrix();
}

// Runs the world and returns the largest growth of its energy.
inline double run(BodyWorld& world, int ticks) {
  double most = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < ticks; ++k) {
    world.begin(kTick);
    world.settle();
    world.finish();
    most = std::max(most, world.gain());
  }
  return most;
}

inline std::vector<double> state(const BodyWorld& world) {
  std::vector<double> all;
  world.write(all);
  return all;
}

// Sets a body's velocity [m/s] and its angular velocity in its own frame [rad/s].
inline void set_moving(BodyWorld& world, int body, const Vec3& speed, const Vec3& spin) {
  world.set_speed(body, speed, world.pose(body).linear() * spin);
}

}  // namespace limpid::test
