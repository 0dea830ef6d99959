// A tip that strokes over a bumpy body: a mesh of a thousand to a million triangles, or a plane.
#pragma once

#include <memory>
#include <vector>

#include "core/tick/tick.h"
#include "core/touch/triangle_mesh.h"
#include "tests/bench/bench_arm.h"

namespace limpid::bench {

// A body of 5 cm radius, with bumps of a centimetre and ripples of a millimetre.
std::shared_ptr<const TriangleMesh> bumpy_body(std::size_t triangles);

// Place of the arm, and of the body or its substitute.
struct StrokePlace {
  ArmDescription arm = chain(3);
  Vec3 middle = tip_of(arm, bent(arm)) * 0.75 + Vec3(0.05, 0, 0);

  // Scene with the body. `capsule`: the last link touches as well, except where only the tip
  // reaches in.
  Scene on_mesh(std::shared_ptr<const TriangleMesh> shape, double tip_radius, bool capsule) const;
  Scene on_plane(double tip_radius, bool capsule) const;
};

// Leads a tip over the front of the body, pressed in from outside: figures of 3 cm at 0.05 to 0.15
// m/s.
class Stroke {
 public:
  // Errors: std::runtime_error if the arm does not reach the body.
  Stroke(const StrokePlace& place, double tip_radius, const Scene& scene);

  // Moves the device's tip to the next place, with exact encoders.
  void move();
  void control() { tick_.run(p_, {x_, x_, Vec<3>::Zero()}, ForceRequest::as_it_is, row_); }
  Vec3 tip() const { return target(k_); }
  bool touches() const { return !tick_.proxy().f().isZero(0); }
  bool diverged() const { return tick_.diverged(); }

 private:
  Vec3 target(int k) const;

  Parameters p_;
  Vec3 middle_;
  double reach_;
  ArmDescription arm_;
  Tick<3> tick_;
  std::vector<double> row_;
  Vec<3> x_;
  int k_ = 0;
};

}  // namespace limpid::bench
