// A convex part of a body, or a fixed object, as Bullet has it.
#pragma once

#include <btBulletCollisionCommon.h>

#include <memory>
#include <optional>
#include <vector>

#include "core/touch/body_geometry.h"
#include "core/touch/contact_points.h"
#include "core/touch/face_points.h"

namespace limpid {

struct CollisionSolid {
  static constexpr double kNear = 1e-3;  // points further apart than this are ignored [m]
  static constexpr double kWide = 10;    // half the edge of the box that represents a plane [m]

  int body = BodyContact::kStill;
  int object = 0;
  Pose in_object = Pose::Identity();
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btTriangleMesh> triangles;
  std::unique_ptr<TouchedModel> model;
  btCollisionObject at;
  std::optional<btVector3> level;  // normal of a plane
  btScalar height = 0;             // the plane's coordinate along it [m]
  btVector3 low, high;             // box around it, slightly enlarged
  double least = 0;                // smallest extent [m]
  std::optional<RoundPart> round;
  double radius = 0, half = 0;  // of a round one; half of its length [m]
  std::vector<Vec3> corners;    // of a box or a hull that moves, in its own frame [m]
  Vec3 middle = Vec3::Zero();   // of these corners [m]
  std::vector<HullFace> faces;  // of a box, and of a hull of few corners

  bool rolls() const { return round && !round->axis.isZero(0); }
  bool boxy() const { return shape->getShapeType() == BOX_SHAPE_PROXYTYPE; }
  bool ball() const { return shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE; }
  double thick() const { return model ? 0 : least; }  // a model is a skin [m]
  double reach = 0;  // of what turns with it, from its object's place [m]

  void bound();  // by its present place
  bool overlaps(const btVector3& box_low, const btVector3& box_high) const;
  bool overlaps(const CollisionSolid& other) const { return overlaps(other.low, other.high); }
  // The next four are for the solid at a pose. rod() needs a solid that is round, hull() one with
  // corners.
  Rod rod(const Pose& pose) const;
  Hull hull(const Pose& pose) const;
  // Returns what it may meet a face as; nothing: it is no hull and no rod.
  std::optional<Convex> convex(const Pose& pose) const;
  // Returns its flat face that is towards another solid; nothing if it has none there.
  std::optional<Face> face_towards(const Convex& other, const Pose& pose) const;
  // Returns whether it may meet flat faces of another one by its own geometry. Boxes among
  // themselves meet in points that Bullet finds well.
  bool meets_faces_of(const CollisionSolid& flat) const;
};

// Returns the pose of the large box below a plane: for its faces and edges Bullet finds all points
// at once.
Pose block_below(const Plane& plane, const Pose& pose);

// Makes a solid of a shape; null: the shape has no place in space.
std::unique_ptr<CollisionSolid> collision_solid(const Shape& shape, const Pose& in_object,
                                                int object, int body);

}  // namespace limpid
