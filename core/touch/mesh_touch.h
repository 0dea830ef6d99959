// Contact of one ball with one mesh: the places that the surface leaves to its centre.
#pragma once

#include <array>
#include <optional>

#include "core/math/sizes.h"
#include "core/touch/scene.h"
#include "core/touch/triangle_mesh.h"

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

// Tracks one ball on one mesh. A free point g follows the ball's centre c as near as the surface
// lets it (after Zilles and Salisbury's god object). It never crosses the mesh, so it knows the
// side, even of a sheet without thickness. Planes stop g: on a face one, in a groove two, in a
// corner three. They bound the free space to which the contact's spring pulls c back. Over a convex
// edge the ball rolls while it is pressed in by less than its radius. Pressed deeper it slips off
// some edges; the force's anchor then follows at a bounded speed, so that the force never jumps,
// and slipping only takes energy away.
class MeshTouch {
 public:
  // mesh: an object with a Mesh as its shape; radius: of the ball [m].
  MeshTouch(const Object& mesh, double radius);

  // Begins anew at c [m]. A centre inside a closed mesh is put outside, at the nearest place; one
  // behind a sheet stays there.
  void place(const Vec3& c);
  // Follows the centre to c [m] within a tick of length T [s].
  void follow(const Vec3& c, double T);
  // Moves the mesh's object to a pose, and with it the free space and the anchor.
  void move(const Pose& object);
  // True if mesh, place, scale and radius are the same.
  bool same_surface(const MeshTouch& other) const;
  // Takes over the state of another one of the same surface.
  void take_over(const MeshTouch& other);

  // True if the mesh may be touched within a tick.
  bool near() const { return near_; }
  // True if the spring leads to one point, anchor(), instead of the room.
  bool held() const { return held_; }
  const FreeSpace& space() const { return world_; }
  const Vec3& anchor() const { return anchor_; }  // [m]
  // True if a start from here would find the same side.
  bool recoverable() const;
  double radius() const { return radius_; }

  // The following serve things that meet. True if the centre c is itself behind a plane of the
  // room.
  bool holds(const Vec3& c) const;
  // Lifts a point out of all planes of the surface, to `above` them.
  Vec3 lifted(Vec3 point, double above) const;
  // Place of the surface nearest to a free point, if the room has one plane.
  std::optional<Vec3> nearest_to(const Vec3& from) const;
  // True if a point is within a distance of the mesh.
  bool meets(const Vec3& point, double within) const;
  // Lets nothing push until the next follow(): the surface here is inside of something else.
  void hide();

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

  // State in mesh units, around the mesh's middle.
  double r_ = 0, skin_ = 0, tolerance_ = 0, look_ = 0;
  Vec3 g_ = Vec3::Zero(), p_ = Vec3::Zero();
  double distance_ = 0;   // lower bound from g to the mesh
  double clearance_ = 0;  // lower bound from the ball to the mesh
  std::uint32_t hint_ = MeshPoint::kNone;
  FreeSpace space_;

  // State in the world.
  FreeSpace world_;
  Vec3 anchor_ = Vec3::Zero();
  bool near_ = false, held_ = false, lost_ = false;
};

}  // namespace limpid
