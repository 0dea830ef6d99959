// Touch of one probe of the arm on all plain solids, beside meshes: the surfaces that hold it.
#pragma once

#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "core/touch/body_world.h"
#include "core/touch/mesh_touch.h"
#include "core/touch/obstacle_distance.h"

namespace limpid {

// An object of a plain shape in the form that a tick needs.
struct Solid {
  std::variant<Plane, Sphere, Box, Cylinder, Capsule> shape;  // shapes of distance_to()
  Pose pose;
  Material material;
  int body = BodyContact::kStill;
  Pose in_body = Pose::Identity();
};

// Knows for each solid the side on which the probe is. A point inside of a solid is held by the
// surface nearest to it, but never by one that faces the other way than its side does: however deep
// it is pressed, it leaves a thin board where it came in. The place that it is held to is its free
// place, outside of all solids; a segment has none and is looked at where it is.
//
// Things that meet are one: a surface inside of another thing is no surface. Seen from the free
// place, a solid or a mesh counts only if no other one that holds its nearest point is nearer. So
// seams between level faces are not felt; of level faces on top of each other the first counts,
// solids before meshes.
class SolidTouch {
 public:
  // A solid within reach.
  struct Near {
    std::size_t solid = 0;  // index
    Vec3 point;             // of the probe, nearest to it [m]
    Surface surface;        // with the distance of the point from it
    bool counts = true;     // nothing else covers this surface
    bool inside = false;    // the point is in the solid
    Surface seen{};         // from the free place
  };

  // radius: of the probe [m].
  SolidTouch(double radius, std::size_t solids) : radius_(radius), sides_(solids), near_(solids) {}

  // Sets the meshes that the same ball touches. They outlive this.
  void set_meshes(std::vector<const MeshTouch*> meshes) { meshes_ = std::move(meshes); }
  // Looks at all solids from the probe's new place. `free`: a ball's centre, lifted out of meshes
  // that hold it.
  void look(std::span<const Solid> solids, const Vec3& from, const Vec3& to, const Vec3& free);
  // Chooses the surfaces; the answer is in the solids' order. Two half spaces never cover each
  // other.
  std::span<const Near> settle(std::span<const Solid> solids);
  std::span<const Near> find(std::span<const Solid> solids, const Vec3& from, const Vec3& to) {
    look(solids, from, to, from);
    return settle(solids);
  }
  // Lifts a point out of the solids that hold the probe's point, or, `whole`, the probe; until
  // settle() of those that held it last.
  Vec3 lifted(std::span<const Solid> solids, Vec3 point, bool whole) const;
  // True if a solid covers a place of a mesh, seen from a free place.
  bool covers(std::span<const Solid> solids, const Vec3& place, const Vec3& free) const;
  // Forgets all sides: the next find() takes the nearest surfaces.
  void forget();
  // The solids of the last look(), in their order.
  std::span<const Near> near() const { return {near_.data(), count_}; }
  // True if find() without memory would have found the same.
  bool recoverable() const { return recoverable_; }

 private:
  // Outward normal of the surface at which the probe was last, in the frame of a body; zero: none.
  // `counts`: nothing covered it; `holds`: the point was inside of it besides.
  struct Side {
    Vec3 normal = Vec3::Zero();
    bool counts = false, holds = false;
  };

  // Solids that may cover a surface: all, or those that are not around the point.
  enum class Asked { all, not_inside };

  std::span<Near> nears() { return {near_.data(), count_}; }
  void lift_out(std::span<const Solid> solids, bool by_sides);
  void choose(std::span<const Solid> solids, Near& near);
  bool covered(std::span<const Solid> solids, const Near& near, const Vec3& point,
               const Surface& surface, Asked asked);
  Surface exposed(std::span<const Solid> solids, const Near& near, const Vec3& point,
                  const Surface& else_, Asked asked);
  Surface entered(std::span<const Solid> solids, const Near& near, const Surface& nearest);
  void hide_covered(std::span<const Solid> solids);
  bool hidden_by_mesh(const Solid& solid, const Near& near, const Vec3& place) const;

  double radius_;
  std::vector<Side> sides_;  // by solid
  std::vector<Near> near_;
  std::size_t count_ = 0;
  std::vector<const MeshTouch*> meshes_;
  Vec3 free_ = Vec3::Zero();
  bool ball_ = true;
  bool recoverable_ = true;
};

}  // namespace limpid
