// Collision detection: points where bodies touch each other and fixed objects.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/touch/impact.h"
#include "core/touch/scene.h"

namespace limpid {

// A ball, cylinder or capsule as a part of an object: it rolls, and its contact point does not turn
// along with it.
struct RoundPart {
  Vec3 center = Vec3::Zero();  // in the object's frame [m]
  Vec3 axis = Vec3::Zero();    // about which it rolls, there; zero for a ball: about any
};

// A point where a body meets another one or a fixed object. It lasts as long as the same places of
// both are near each other, and keeps the state of its force.
struct BodyContact {
  static constexpr int kStill = -1;

  int a = 0, b = kStill;                                   // bodies
  int object_a = 0, object_b = 0;                          // objects of the scene
  Vec3 point = Vec3::Zero();                               // in the middle of the overlap [m]
  Vec3 normal = Vec3::UnitZ();                             // out of b, unit
  double depth = 0;                                        // negative: apart [m]
  const RoundPart *round_a = nullptr, *round_b = nullptr;  // its sides that roll
  // The contact and its normal in the middle of the tick, as bodies go; if they are known.
  bool goes_on = false;
  Vec3 next_point = Vec3::Zero(), next_normal = Vec3::UnitZ();

  // The rest is kept from tick to tick.
  double lost = 0;  // energy lost in its damper and in impacts, not yet paid back [J]
  // Depth that was not pressed in: it was there when they met, or the nearest features of two
  // shapes changed. It causes no force [m].
  double rest = 0;
  double pressed = 0;            // depth pressed in by the end of the last tick [m]
  double force = 0;              // along the normal, on a [N]
  Vec3 friction = Vec3::Zero();  // on a [N]
  Vec3 anchor = Vec3::Zero();    // stretch of friction's spring [m]
  bool slipping = false;
  Impact impact{};
  bool seen = false;
};

// A meeting of a body on its way with another one or a fixed object.
struct Meeting {
  struct Point {
    Vec3 at = Vec3::Zero();       // [m]
    Vec3 normal = Vec3::UnitZ();  // out of b, unit
  };
  double part = 1;                 // of the way; 1: nowhere
  int a = 0, b = 0;                // bodies
  int object_a = 0, object_b = 0;  // objects of the scene
  std::array<Point, 4> points{};
  std::size_t count = 0;  // of points
};

// Finds these points with Bullet's collision library in double precision. Takes all memory when it
// is made. The same poses in the same order give the same points, bit for bit.
class BodyGeometry {
 public:
  // Bodies are the objects of the scene that have one, in its order. At most kMost points exist at
  // a time: further ones are left out, and counted.
  explicit BodyGeometry(const Scene& scene);
  ~BodyGeometry();
  BodyGeometry(BodyGeometry&&) noexcept;
  BodyGeometry& operator=(BodyGeometry&&) noexcept;

  static constexpr int kMost = 512;

  void place(int body, const Pose& pose);
  // Returns whether there is a ball, a cylinder or a capsule.
  bool any_round() const;
  // Updates the points of all pairs with an awake body, in the order of the pairs. `next`: poses of
  // bodies in the middle of the tick; round ones need them.
  void search(std::span<const std::uint8_t> awake, std::span<const Pose> next);
  std::span<BodyContact* const> points() const;
  // True if a body that goes so far, and turns by so much, may pass something between two searches
  // [m, rad].
  bool may_pass(int body, double way, double turned) const;
  // The place where a body first meets something, or goes deeper into what it is in, on its way to
  // a pose. Looks only at what it may pass by so many times its way; never at planes, which nothing
  // passes.
  Meeting first_meeting(int body, const Pose& from, const Pose& to, const Vec3& center,
                        double times);
  int left_out() const;  // of the last search()
  // True if the boxes around two bodies, slightly enlarged, overlap.
  bool near(int a, int b) const;
  void forget();  // forgets all points

  // Appends all state that is kept from tick to tick, as numbers.
  void write(std::vector<double>& into) const;
  // Restores that state; returns the numbers that follow it.
  std::span<const double> read(std::span<const double> from);

 private:
  struct Inside;
  std::unique_ptr<Inside> in_;
};

}  // namespace limpid
