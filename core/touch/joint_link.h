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

  static constexpr bool kWakes = true;
  void prepare(Bodies& bodies);
  double energy(const Bodies& bodies) const;

  std::array<double, 4> numbers() const {
    return {force.on_a.x(), force.on_a.y(), force.on_a.z(), 0};
  }
  void read(const double* from) { force.on_a = Eigen::Map<const Vec3>(from); }

 private:
  void prepare_rail(Bodies& bodies);
};

// Appends the links of a body's joint, with body `to` or the world.
void add_links(const Bodies& bodies, int body, int to, std::vector<JointLink>& links);

}  // namespace limpid
