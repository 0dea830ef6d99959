// Places that planes leave free to a ball's centre.
#pragma once

#include <array>

#include "core/math/sizes.h"

namespace limpid {

// The room that a few planes leave, and the force of a spring back into it. It is all points on the
// outer side of the planes, {x : n_i . x >= o_i}, with unit normals n_i and offsets o_i in the unit
// of x. A contact of stiffness K pulls a point c back to the nearest x of this convex set. The
// potential K |x - c|^2 / 2 is convex with a continuous gradient, and x moves no further than c
// does.
class FreeSpace {
 public:
  static constexpr int kMostPlanes = 6;

  // The planes that hold x, at most three.
  struct Active {
    std::array<int, 3> plane{};
    int count = 0;
    friend bool operator==(const Active& a, const Active& b);
  };

  FreeSpace() { normals_.fill(Vec3::Zero()); }

  void clear() { count_ = 0; }
  int count() const { return count_; }
  // False if there is no room for another one.
  bool add(const Vec3& normal, double offset);
  const Vec3& normal(int i) const { return normals_[static_cast<std::size_t>(i)]; }
  double offset(int i) const { return offsets_[static_cast<std::size_t>(i)]; }

  // Finds the nearest x to c, the planes that hold it there, and their weights: x = c + sum of w_i
  // n_i, w_i >= 0. False if the planes leave no room near enough to tell.
  bool project(const Vec3& c, Vec3& x, Active& active, Vec3& weights) const;
  bool project(const Vec3& c, Vec3& x, Active& active) const {
    Vec3 weights;
    return project(c, x, active, weights);
  }
  // Nearest x to c that lies on all active planes, n_i . x = o_i, without regard to the others.
  Vec3 onto(const Vec3& c, const Active& active) const;
  // Sets columns e_j of `e` to an orthonormal basis of the active normals' span; returns how many.
  // The spring's force on c is K sum_j e_j (e_j . (x - c)).
  int basis(const Active& active, Mat3& e) const;

 private:
  bool solve(const Vec3& c, const Active& active, Vec3& x, Vec3& weights) const;
  bool extend(const Active& active, int i, Mat3& e, Mat3& r) const;
  bool holds(const Vec3& c, const Vec3& x, const Active& except) const;

  std::array<Vec3, kMostPlanes> normals_;
  std::array<double, kMostPlanes> offsets_{};
  int count_ = 0;
};

// Height of a free place above the surfaces that hold it. Distance within which two things meet: a
// gap or a step of less is none. Difference of distances that says nothing: models are rounded by
// less. All in [m].
inline constexpr double kAbove = 2e-6, kMeeting = 1e-6, kTied = 1e-8;

// The free places of a ball's centre beside what it touches, as its contact's spring sees them.
class Room {
 public:
  // radius: of the ball [m].
  explicit Room(double radius) : radius_(radius) {}

  // True if something may be touched within a tick.
  bool near() const { return near_; }
  // True if the spring leads to one point, anchor(), instead of the space.
  bool held() const { return held_; }
  const FreeSpace& space() const { return world_; }
  const Vec3& anchor() const { return anchor_; }  // [m]
  double radius() const { return radius_; }       // [m]

 protected:
  double radius_;
  FreeSpace world_;
  Vec3 anchor_ = Vec3::Zero();
  bool near_ = false, held_ = false;
};

}  // namespace limpid
