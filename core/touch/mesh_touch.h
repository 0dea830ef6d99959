// Touch of one ball on one mesh: the places that the surface leaves to its centre.
#pragma once

#include <optional>

#include "core/touch/free_space.h"
#include "core/touch/scene.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {

// Tracks one ball on one mesh. A free point g follows the ball's centre c as near as the surface
// lets it (after Zilles and Salisbury's god object). It never crosses the mesh, so it knows the
// side, even of a sheet without thickness. Planes stop g: on a face one, in a groove two, in a
// corner three. They bound the free space to which the contact's spring pulls c back. Over a convex
// edge the ball rolls while it is pressed in by less than its radius. Pressed deeper it slips off
// some edges; the force's anchor then follows at a bounded speed, so that the force never jumps,
// and slipping only takes energy away.
class MeshTouch : public Room {
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

  // True if a start from here would find the same side.
  bool recoverable() const;

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
  double scale_;

  // State in mesh units, around the mesh's middle.
  double r_ = 0, skin_ = 0, tolerance_ = 0, look_ = 0;
  Vec3 g_ = Vec3::Zero(), p_ = Vec3::Zero();
  double distance_ = 0;   // lower bound from g to the mesh
  double clearance_ = 0;  // lower bound from the ball to the mesh
  std::uint32_t hint_ = MeshPoint::kNone;
  FreeSpace space_;

  bool lost_ = false;
};

}  // namespace limpid
