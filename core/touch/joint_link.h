// Part of a joint between two bodies, or of a ball joint with the world: a stiff spring that holds
// a point of one at a point of the other. A ball joint has one of them; a hinge two on its axis; a
// slider three, one off its axis, each free along it: rails.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/touch/point_force.h"

namespace limpid {

struct JointLink : HeldForce {
  int a = 0, b = BodyContact::kStill;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();  // in their objects' frames, or the world's [m]
  std::optional<Vec3> rail_axis;                  // in the frame of b
  Mat3 held = Mat3::Identity();                   // in the tick: onto directions that are not free
  // The stretch that the forces so far made, and energy that the damper took [m, J]. A tick's
  // rotation leads to another one by third order: it is taken as far as it stores no more energy
  // than this.
  Vec3 made_stretch = Vec3::Zero();
  double lost = 0;

  static constexpr bool kWakes = true;
  void prepare(Bodies& bodies);
  // Takes the places of its points in the middle of the tick anew, for bodies that turn by far. A
  // rail keeps them.
  void turn(Bodies& bodies);
  double made(const Bodies& bodies) const {
    const Vec3 way = bodies.T * (held * force.speed(bodies));
    return way.dot(force.on_a + point.K * (point.stretch + way / 2));
  }
  // The velocity that is left: zero for the right force [m/s].
  Vec3 left(const Bodies& bodies) const {
    return held * force.speed(bodies) +
           (point.K * point.stretch + force.on_a) / point.push(bodies.T);
  }
  // Velocity of stretching at the tick's start [m/s].
  Vec3 stretching(const Bodies& bodies) const {
    const Vec3 at = bodies.place(a, on_a);
    const Vec3 there = rail_axis ? at : bodies.place(b, on_b);
    return held * (bodies.speed_at(a, at) - bodies.speed_at(b, there));
  }
  void finish(const Bodies& bodies);
  double energy(const Bodies&) const { return 0.5 * point.K * made_stretch.squaredNorm(); }

  std::array<double, 7> numbers() const {
    return {force.on_a.x(),
            force.on_a.y(),
            force.on_a.z(),
            made_stretch.x(),
            made_stretch.y(),
            made_stretch.z(),
            lost};
  }
  void read(const double* from) {
    force.on_a = Eigen::Map<const Vec3>(from);
    made_stretch = Eigen::Map<const Vec3>(from + 3);
    lost = from[6];
  }

 private:
  void prepare_rail(Bodies& bodies);
  void stretch(const Vec3& to);
};

// Appends the links of a body's joint, with body `to` or the world.
void add_links(const Bodies& bodies, int body, int to, std::vector<JointLink>& links);

}  // namespace limpid
