#include "core/touch/collision_solid.h"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace limpid {
namespace {

std::vector<Vec3> corners_of(const Box& box) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 side((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners.push_back(0.5 * side.cwiseProduct(box.size));
  }
  return corners;
}

constexpr std::size_t kMostFlat = 64;  // corners of a hull whose faces are looked at in each tick
// Corners that are so far from a plane, in parts of the hull's size, are in it.
constexpr double kSame = 1e-5;
constexpr double kHole = 1e-3;  // part of a hull's surface that its faces may leave out

// Takes the corners of the hull around points, as they are: Bullet's own shape rounds them to a
// ten-thousandth of the hull's size. Then its flat sides, the large ones first, if its corners are
// few.
void take_corners(const std::vector<btVector3>& points, CollisionSolid& solid) {
  btConvexHullComputer hull;
  hull.compute(points.front().m_floats, static_cast<int>(sizeof(btVector3)),
               static_cast<int>(points.size()), 0, 0);
  Vec3 low = from_bullet(points.front()), high = low;
  for (int i = 0; i < hull.vertices.size(); ++i) {
    const auto number = static_cast<std::size_t>(hull.original_vertex_index[i]);
    solid.corners.push_back(from_bullet(points[number]));
    low = low.cwiseMin(solid.corners.back());
    high = high.cwiseMax(solid.corners.back());
  }
  for (const Vec3& corner : solid.corners)
    solid.middle += corner / static_cast<double>(solid.corners.size());
  if (solid.corners.size() > kMostFlat) return;
  struct Side {
    Vec3 area = Vec3::Zero();  // along its normal [m^2]
    double longest = 0;        // of its edges [m]
  };
  std::vector<Side> sides;
  for (int i = 0; i < hull.faces.size(); ++i) {
    const auto* first = &hull.edges[hull.faces[i]];
    const auto corner = [&](int vertex) { return solid.corners[static_cast<std::size_t>(vertex)]; };
    const Vec3 from = corner(first->getSourceVertex());
    Side& side = sides.emplace_back();
    const auto* edge = first;
    do {
      const Vec3 one = corner(edge->getSourceVertex()), two = corner(edge->getTargetVertex());
      side.area += 0.5 * (one - from).cross(two - from);
      side.longest = std::max(side.longest, (two - one).norm());
      edge = edge->getNextEdgeOfFace();
    } while (edge != first);
  }
  std::ranges::sort(sides, std::ranges::greater(), [](const Side& one) { return one.area.norm(); });
  const double same = kSame * (high - low).norm();
  double all = 0, flat = 0;  // areas of the sides, and of the faces [m^2]
  for (const auto& [area, longest] : sides) {
    all += area.norm();
    if (area.norm() <= same * longest) continue;  // what is so narrow has no normal
    HullFace face = hull_face(solid.corners, area.normalized(), same);
    const bool known = std::ranges::any_of(solid.faces, [&](const HullFace& other) {
      return face.normal.dot(other.normal) > 0 && (face.center - other.center).norm() < same;
    });
    if (known || face.outline.size() < 3) continue;
    for (std::size_t k = 0; k < face.outline.size(); ++k) {
      const Vec2 &one = face.outline[k], &two = face.outline[(k + 1) % face.outline.size()];
      flat += 0.5 * (one.x() * two.y() - one.y() * two.x());
    }
    solid.faces.push_back(std::move(face));
  }
  // A solid with a hole in its faces would be met inside of itself.
  if (std::abs(flat - all) > kHole * all) solid.faces.clear();
}

// Adds a model: its triangles if it stands still, else its convex hull.
void add_model(const Mesh& mesh, CollisionSolid& solid) {
  solid.in_object = mesh.stood(Pose::Identity());
  const TriangleMesh& triangles = *mesh.triangles;
  const auto corners = [&](std::size_t t) {
    std::array<btVector3, 3> all;
    std::ranges::transform(triangles.corners(t), all.begin(), [&](const Vec3& corner) {
      return to_bullet(Vec3(mesh.size() * (corner + triangles.middle())));
    });
    return all;
  };
  if (solid.body == BodyContact::kStill) {
    solid.triangles = std::make_unique<btTriangleMesh>();
    for (std::size_t t = 0; t < triangles.triangles(); ++t) {
      const auto at = corners(t);
      solid.triangles->addTriangle(at[0], at[1], at[2]);
    }
    solid.shape = std::make_unique<btBvhTriangleMeshShape>(solid.triangles.get(), true);
    solid.model = std::make_unique<TouchedModel>(
        TouchedModel{mesh.triangles, MeshEdges(mesh.triangles), mesh.size()});
    solid.at.setUserPointer(solid.model.get());
  } else {
    std::vector<btVector3> points;
    for (std::size_t t = 0; t < triangles.triangles(); ++t) {
      std::ranges::copy(corners(t), std::back_inserter(points));
    }
    take_corners(points, solid);
    auto hull = std::make_unique<btConvexHullShape>();
    for (const Vec3& corner : solid.corners) hull->addPoint(to_bullet(corner), false);
    hull->recalcLocalAabb();
    solid.shape = std::move(hull);
  }
  solid.shape->setMargin(kMargin);
  btVector3 low, high;
  solid.shape->getAabb(btTransform::getIdentity(), low, high);
  const btVector3 size = high - low;
  solid.least = std::min({size.x(), size.y(), size.z()});
}

}  // namespace

void CollisionSolid::bound() {
  shape->getAabb(at.getWorldTransform(), low, high);
  const btVector3 more(kNear, kNear, kNear);
  low -= more;
  high += more;
}

bool CollisionSolid::overlaps(const btVector3& box_low, const btVector3& box_high) const {
  return box_low.x() <= high.x() && low.x() <= box_high.x() && box_low.y() <= high.y() &&
         low.y() <= box_high.y() && box_low.z() <= high.z() && low.z() <= box_high.z();
}

std::optional<Convex> CollisionSolid::convex(const Pose& pose) const {
  if (round) return rod(pose);
  if (corners.empty()) return std::nullopt;
  return hull(pose);
}

Hull CollisionSolid::hull(const Pose& pose) const {
  return {.pose = pose, .corners = corners, .center = pose * middle, .faces = faces};
}

Rod CollisionSolid::rod(const Pose& pose) const {
  return {.center = pose.translation(),
          .axis = pose.linear().col(2),
          .radius = radius,
          .half = half,
          .round_ends = shape->getShapeType() != CYLINDER_SHAPE_PROXYTYPE};
}

std::optional<Face> CollisionSolid::face_towards(const Convex& other, const Pose& pose) const {
  if (level) {
    Face plane{.center = height * from_bullet(*level), .normal = from_bullet(*level)};
    plane.along[0] = plane.normal.unitOrthogonal();
    plane.along[1] = plane.normal.cross(plane.along[0]);
    return plane;
  }
  if (!faces.empty()) return face_of_hull(other, hull(pose));
  const Rod own = rod(pose);
  return own.round_ends ? std::nullopt : end_of_cylinder(other, own);
}

bool CollisionSolid::meets_faces_of(const CollisionSolid& flat) const {
  if (!round && corners.empty()) return false;
  if (flat.level) return true;
  if (!flat.faces.empty()) return !boxy() || !flat.boxy();
  return flat.rolls() && flat.shape->getShapeType() == CYLINDER_SHAPE_PROXYTYPE;
}

Pose block_below(const Plane& plane, const Pose& pose) {
  Pose block = Pose::Identity();
  block.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), plane.normal).matrix();
  block.translation() = pose.translation() - CollisionSolid::kWide * plane.normal;
  return block;
}

std::unique_ptr<CollisionSolid> collision_solid(const Shape& shape, const Pose& in_object,
                                                int object, int body) {
  auto solid = std::make_unique<CollisionSolid>();
  solid->body = body;
  solid->object = object;
  solid->in_object = in_object;
  if (const auto* box = std::get_if<Box>(&shape)) {
    solid->shape = std::make_unique<btBoxShape>(to_bullet(Vec3(box->size / 2)));
    solid->least = box->size.minCoeff();
    solid->shape->setMargin(std::min(kMargin, 0.05 * solid->least));
    solid->corners = corners_of(*box);
    solid->faces = faces_of_box(box->size / 2);
  } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    solid->shape = std::make_unique<btSphereShape>(sphere->radius);
    solid->least = 2 * sphere->radius;
    solid->radius = sphere->radius;
    solid->round = RoundPart{in_object.translation()};
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const double r = cylinder->radius;
    solid->shape = std::make_unique<btCylinderShapeZ>(btVector3(r, r, cylinder->length / 2));
    solid->shape->setMargin(std::min(kMargin, 0.1 * std::min(r, cylinder->length)));
    solid->least = std::min(2 * r, cylinder->length);
    solid->round = RoundPart{in_object.translation(), in_object.linear().col(2)};
    solid->radius = r;
    solid->half = cylinder->length / 2;
  } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    solid->shape = std::make_unique<btCapsuleShapeZ>(capsule->radius, capsule->length);
    solid->least = 2 * capsule->radius;
    solid->round = RoundPart{in_object.translation(), in_object.linear().col(2)};
    solid->radius = capsule->radius;
    solid->half = capsule->length / 2;
  } else if (std::holds_alternative<Plane>(shape)) {
    solid->shape = std::make_unique<btBoxShape>(
        btVector3(CollisionSolid::kWide, CollisionSolid::kWide, CollisionSolid::kWide));
    solid->least = 1;
  } else if (const auto* mesh = std::get_if<Mesh>(&shape); mesh != nullptr && mesh->triangles) {
    add_model(*mesh, *solid);
  } else {
    static_assert(kShapes == 7);
    return nullptr;  // a joint's stop
  }
  solid->at.setCollisionShape(solid->shape.get());
  btVector3 around;
  btScalar radius = 0;
  solid->shape->getBoundingSphere(around, radius);
  solid->reach = in_object.translation().norm() + (solid->ball() ? 0 : radius);
  return solid;
}

}  // namespace limpid
