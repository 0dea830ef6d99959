// One ball against one mesh: where the surface lets its centre be.
#pragma once

#include <array>

#include "core/math/sizes.h"
#include "core/touch/scene.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {

// The room that a few planes leave, and the force of a spring back into it.

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

  // The nearest x to c, what holds it there, and how each of these pulls: x = c + sum of w_i n_i,
  // w_i >= 0. False if the planes leave no room near enough to tell.
  bool project(const Vec3& c, Vec3& x, Active& active, Vec3& weights) const;
  bool project(const Vec3& c, Vec3& x, Active& active) const {
    Vec3 weights;
    return project(c, x, active, weights);
  }
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

// A free point g follows the ball's centre c as near as the surface lets it (after Zilles and
// Salisbury's god object): it never crosses the mesh, so that it knows the side, of a sheet without
// thickness as well. The planes that stop g (on a face one, in a groove two, in a corner three)
// bound the free space to which the contact's spring pulls c back. Over a convex edge the ball
// rolls, as long as it is pressed in by less than its radius. Pressed deeper it slips off some
// edges; the anchor of the force then follows at a bounded speed, so that the force never jumps,
// and slipping only takes energy away.
class MeshTouch {
 public:
  MeshTouch(const Object& mesh, double radius);  // whose shape is one; of the ball [m]

  // Starts anew at c [m]. A centre inside of a closed mesh belongs outside, at the nearest place;
  // one behind a sheet stays there.
  void place(const Vec3& c);
  // To c [m] within a tick of length T [s].
  void follow(const Vec3& c, double T);
  // The mesh's object is there now; where the ball may be, and where it is held, go with it.
  void move(const Pose& object);
  // Of the same mesh, place, scale and radius.
  bool same_surface(const MeshTouch& other) const;
  // Takes over where another one of the same surface is.
  void take_over(const MeshTouch& other);

  // Near enough to touch within a tick.
  bool near() const { return near_; }
  // A spring to one point, anchor(), instead of to the room.
  bool held() const { return held_; }
  const FreeSpace& space() const { return world_; }
  const Vec3& anchor() const { return anchor_; }  // [m]
  // Starting anew here would find the same side again.
  bool recoverable() const;
  double radius() const { return radius_; }

 private:
  MeshTouch(const Mesh& mesh, const Pose& pose, double radius);
  Vec3 to_mesh(const Vec3& world) const;
  Vec3 to_world(const Vec3& local) const;
  bool advance(const Vec3& p);
  enum class Guess { none, near, right };
  Guess guess(const Vec3& p, Vec3& t);
  bool keep_only(const MeshPoint& at, const Vec3& from, const Vec3& p, Vec3& t);
  bool keep_also(const MeshPoint& at, const Vec3& out, const Vec3& p, Vec3& t);
  bool step_to(const MeshPoint& at, const Vec3& out);
  Vec3 out_of(const MeshPoint& at, const Vec3& from) const;
  void settle_at(const Vec3& g, const MeshPoint& near);
  void let_go(const Vec3& p, double clearance);
  void publish();

  std::shared_ptr<const TriangleMesh> shape_;
  bool closed_;
  Pose pose_, in_object_;
  double scale_, radius_;

  // In mesh units, around its middle:
  double r_ = 0, skin_ = 0, tolerance_ = 0, look_ = 0;
  Vec3 g_ = Vec3::Zero(), p_ = Vec3::Zero();
  double distance_ = 0;   // from g to the mesh, at least
  double clearance_ = 0;  // from the ball to the mesh, at least
  std::uint32_t hint_ = MeshPoint::kNone;
  FreeSpace space_;

  // In the world:
  FreeSpace world_;
  Vec3 anchor_ = Vec3::Zero();
  bool near_ = false, held_ = false, lost_ = false;
};

}  // namespace limpid
