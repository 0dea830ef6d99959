// The room that a few planes leave, and the force of a spring back into it.
#pragma once

#include <array>

#include "core/math/sizes.h"

namespace limpid {

// All points on the outer side of some planes, {x : n_i . x >= o_i}, with unit normals n_i and
// offsets o_i in the unit of x. A contact of stiffness K pulls a point c back to the nearest x of
// this convex set: the potential K |x - c|^2 / 2 is convex with a continuous gradient, and x moves
// no further than c does.
class FreeSpace {
 public:
  static constexpr int kMostPlanes = 6;

  // The planes that hold x, at most three.
  struct Active {
    std::array<int, 3> plane{};
    int count = 0;
    friend bool operator==(const Active& a, const Active& b);
  };

  void clear() { count_ = 0; }
  int count() const { return count_; }
  // False if there is no room for another one.
  bool add(const Vec3& normal, double offset);
  const Vec3& normal(int i) const { return normals_[static_cast<std::size_t>(i)]; }
  double offset(int i) const { return offsets_[static_cast<std::size_t>(i)]; }

  // The nearest x to c and what holds it there; false if the planes leave no room near enough to
  // tell.
  bool project(const Vec3& c, Vec3& x, Active& active) const;
  // The nearest x to c that lies on all of these planes, n_i . x = o_i, whatever the others say.
  Vec3 onto(const Vec3& c, const Active& active) const;
  // Columns e_j of `e`: an orthonormal basis of what the active normals span; returns how many. The
  // spring's force on c is K sum_j e_j (e_j . (x - c)).
  int basis(const Active& active, Mat3& e) const;

 private:
  bool solve(const Vec3& c, const Active& active, Vec3& x, Vec3& weights) const;
  bool extend(const Active& active, int i, Mat3& e, Mat3& r) const;
  bool holds(const Vec3& c, const Vec3& x, const Active& except) const;

  std::array<Vec3, kMostPlanes> normals_;
  std::array<double, kMostPlanes> offsets_{};
  int count_ = 0;
};

}  // namespace limpid
