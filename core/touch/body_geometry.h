// Where bodies touch each other and what stands still.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/touch/scene.h"

namespace limpid {

// A point where a body meets another one, or what stands still. It lasts as long as the same places
// of both are near each other, and carries along what its force is made of.
struct BodyContact {
  static constexpr int kStill = -1;

  int a = 0, b = kStill;           // bodies
  int object_a = 0, object_b = 0;  // of the scene
  Vec3 point = Vec3::Zero();       // in the middle of the overlap [m]
  Vec3 normal = Vec3::UnitZ();     // out of b, unit
  double depth = 0;                // negative: apart [m]
  // Of a ball the point stays below the centre while it rolls: it does not turn along.
  bool ball_a = false, ball_b = false;

  // From tick to tick:
  double lost = 0;  // by its damper over the last tick [J]
  // Depth that nobody pressed in: it was there when they met, or the nearest features of two shapes
  // changed. It pushes nothing [m].
  double rest = 0;
  double pressed = 0;            // depth to which it was pressed in by the end of the last tick [m]
  double force = 0;              // along the normal, on a [N]
  Vec3 friction = Vec3::Zero();  // on a [N]
  Vec3 anchor = Vec3::Zero();    // stretch of friction's spring [m]
  bool slipping = false;
  bool seen = false;
};

// Finds these points, by Bullet's collision library in double precision. All memory is taken when
// it is made; the same poses in the same order give the same points, bit for bit.
class BodyGeometry {
 public:
  // Bodies are those objects of the scene that have one, in its order. At most kMost points at a
  // time: further ones are left out, and counted.
  explicit BodyGeometry(const Scene& scene);
  ~BodyGeometry();
  BodyGeometry(BodyGeometry&&) noexcept;
  BodyGeometry& operator=(BodyGeometry&&) noexcept;

  static constexpr int kMost = 512;

  void place(int body, const Pose& pose);
  // Brings the points of all pairs up to date of which one is awake. In the order of the pairs.
  void search(std::span<const std::uint8_t> awake);
  std::span<BodyContact* const> points() const;
  int left_out() const;  // of the last search()
  // Whether the boxes around two bodies, a little larger, overlap.
  bool near(int a, int b) const;
  void forget();  // all points

  // All that is kept from tick to tick, as numbers, behind those there are.
  void write(std::vector<double>& into) const;
  // Returns what is left over of them.
  std::span<const double> read(std::span<const double> from);

 private:
  struct Inside;
  std::unique_ptr<Inside> in_;
};

}  // namespace limpid
