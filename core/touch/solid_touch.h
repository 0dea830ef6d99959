// Touch of one probe of the arm on all plain solids, beside meshes: the surfaces that hold it.
#pragma once

#include <optional>
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

// Follows the probe with its free place, which is as near to the probe as solids and meshes let it.
// The free place never enters a solid: convex as they are, each leaves it the half space beyond the
// surface that faces it. So a thin board holds the probe where it came in, however deep it is
// pressed, a surface inside of another thing is none, and seams between level faces are not felt.
// A solid that holds the probe alone does so by its surface nearest to the probe on that side.
//
// A segment's free place is that of its first end; the segment is moved along, not turned.
class SolidTouch {
 public:
  // A solid within reach.
  struct Near {
    std::size_t solid = 0;  // index
    Vec3 point;             // of the probe, nearest to it [m]
    Surface surface;        // that may hold the probe, with its distance from the point
    bool counts = true;     // nothing else covers this surface
    bool holds = false;     // it keeps the probe from where it would be
  };

  // radius: of the probe [m].
  SolidTouch(double radius, std::size_t solids) : radius_(radius), sides_(solids), near_(solids) {}

  // Sets the meshes that the same ball touches. They outlive this.
  void set_meshes(std::vector<const MeshTouch*> meshes) { meshes_ = std::move(meshes); }
  // Looks at all solids from the probe's new place.
  void look(std::span<const Solid> solids, const Vec3& from, const Vec3& to);
  // Chooses the surfaces; the answer is in the solids' order.
  std::span<const Near> settle(std::span<const Solid> solids);
  std::span<const Near> find(std::span<const Solid> solids, const Vec3& from, const Vec3& to) {
    look(solids, from, to);
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
  // The rest is as in Near; `deep`: the point was inside of it besides.
  struct Side {
    Vec3 normal = Vec3::Zero();
    bool counts = false, holds = false, deep = false;
  };
  // Half space beyond which the free place stays: of a solid, or, null, of a mesh. offset: see
  // FreeSpace.
  struct Stop {
    const Near* near;
    Vec3 normal;
    double offset;
  };
  class Stops;

  std::span<Near> nears() { return {near_.data(), count_}; }
  bool alone(std::span<const Solid> solids);
  bool hold_together(std::span<const Solid> solids);
  void hide_covered(std::span<const Solid> solids);
  bool follow(std::span<const Solid> solids, Stops& stops);
  bool turned(std::span<const Solid> solids, const Near& near) const;
  void face(std::span<const Solid> solids, Near& near) const;
  bool leaps(std::span<const Solid> solids, const Vec3& place, const Stops& stops) const;
  Vec3 point_at(const Solid& solid, const Vec3& place) const;
  double distance(const Solid& solid, const Vec3& place) const;
  bool crossed(const Solid& solid, const Vec3& place, double distance) const;
  std::optional<Stop> blocker(std::span<const Solid> solids, const Vec3& place,
                              const Stops& stops) const;
  Surface see(std::span<const Solid> solids, const Near& near, Vec3& point) const;
  Stop stop_by(std::span<const Solid> solids, const Near& near) const;
  Surface exposed(std::span<const Solid> solids, const Near& near, const Vec3& point,
                  const Surface& nearest) const;
  void hide_in_meshes(std::span<const Solid> solids);
  bool hidden_by_mesh(const Solid& solid, const Vec3& free) const;

  double radius_;
  std::vector<Side> sides_;  // by solid
  std::vector<Near> near_;
  std::size_t count_ = 0;
  std::vector<const MeshTouch*> meshes_;
  Vec3 from_ = Vec3::Zero(), along_ = Vec3::Zero();  // the segment, from and to - from
  Vec3 place_ = Vec3::Zero();                        // free place of `from`
  bool known_ = false;                               // the free place
  double moved_ = 0;                                 // by `from` since the last look() [m]
  bool recoverable_ = true;
};

}  // namespace limpid
