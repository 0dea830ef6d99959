// Contact points of a pair as Bullet finds them, without those that only its triangles have.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <memory>

#include "core/touch/face_points.h"
#include "core/touch/mesh_edges.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {

inline constexpr double kMargin = 1e-4;  // radius by which Bullet rounds some edges [m]

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline btTransform to_bullet(const Pose& pose) {
  const Mat3& R = pose.linear();
  return btTransform(
      btMatrix3x3(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
      to_bullet(Vec3(pose.translation())));
}

inline Pose from_bullet(const btTransform& at) {
  Pose pose = Pose::Identity();
  for (int i = 0; i < 3; ++i) pose.linear().col(i) = from_bullet(at.getBasis().getColumn(i));
  pose.translation() = from_bullet(at.getOrigin());
  return pose;
}

// A model among the solids: a collision object's user pointer.
struct TouchedModel {
  std::shared_ptr<const TriangleMesh> mesh;
  MeshEdges edges;
  double size;
};

// Result of a pair without the friction and other values that Bullet's own class computes for each
// point.
class PairPoints : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;

  bool only_edges = false;  // takes no points on faces of models
  btScalar deepest = 0;     // least distance of a point that Bullet found, if that is negative [m]

  void addContactPoint(const btVector3& normal, const btVector3& on_b, btScalar distance) override {
    const btVector3 on_a = on_b + normal * distance;
    if (touchable(*m_body1Wrap, m_index1, on_b, normal) &&
        touchable(*m_body0Wrap, m_index0, on_a, -normal)) {
      add(normal, on_b, distance);
    }
  }
  // Takes a point in place of a near one.
  void add(const btVector3& normal, const btVector3& on_b, btScalar distance) {
    btPersistentManifold& all = *getPersistentManifold();
    if (distance > all.getContactBreakingThreshold()) return;
    deepest = std::min(deepest, distance);
    const btManifoldPoint point = point_at(normal, on_b, distance);
    if (btManifoldPoint* known = near(all, point.m_localPointA)) {
      known->m_localPointA = point.m_localPointA;
      known->m_localPointB = point.m_localPointB;
      known->m_normalWorldOnB = normal;
      known->m_distance1 = distance;
      known->m_positionWorldOnA = point.m_positionWorldOnA;
      known->m_positionWorldOnB = on_b;
      return;
    }
    all.addManifoldPoint(point);
  }
  // Takes these points, however near each other they are, and no others.
  void take(const FacePoints& points) {
    btPersistentManifold& all = *getPersistentManifold();
    all.clearManifold();
    for (const FacePoints::Point& each : points.all()) {
      all.addManifoldPoint(
          point_at(to_bullet(each.normal), to_bullet(each.on_other()), each.distance));
    }
  }

 private:
  btManifoldPoint point_at(const btVector3& normal, const btVector3& on_b,
                           btScalar distance) const {
    const btVector3 on_a = on_b + normal * distance;
    const bool turned = getPersistentManifold()->getBody0() != m_body0Wrap->getCollisionObject();
    const auto* first = turned ? m_body1Wrap : m_body0Wrap;
    const auto* second = turned ? m_body0Wrap : m_body1Wrap;
    btManifoldPoint point(first->getCollisionObject()->getWorldTransform().invXform(on_a),
                          second->getCollisionObject()->getWorldTransform().invXform(on_b), normal,
                          distance);
    point.m_positionWorldOnA = on_a;
    point.m_positionWorldOnB = on_b;
    return point;
  }
  // False if one of the two is a triangle of a model that cannot be touched there in this
  // direction.
  bool touchable(const btCollisionObjectWrapper& wrap, int triangle, const btVector3& place,
                 const btVector3& direction) const {
    const auto* model =
        static_cast<const TouchedModel*>(wrap.getCollisionObject()->getUserPointer());
    if (model == nullptr) return true;
    const btTransform& at = wrap.getCollisionObject()->getWorldTransform();
    const Vec3 there = from_bullet(at.invXform(place));
    const auto t = static_cast<std::uint32_t>(triangle);
    return model->edges.touchable(t, model->size, there, from_bullet(direction * at.getBasis()),
                                  2 * kMargin) &&
           (!only_edges || model->edges.sharp(t, model->size, there, 2 * kMargin));
  }
  // Returns the existing point that a point there replaces, or null.
  static btManifoldPoint* near(btPersistentManifold& all, const btVector3& own) {
    btScalar least = all.getContactBreakingThreshold() * all.getContactBreakingThreshold();
    btManifoldPoint* nearest = nullptr;
    for (int i = 0; i < all.getNumContacts(); ++i) {
      const btVector3 way = all.getContactPoint(i).m_localPointA - own;
      if (const btScalar distance = way.dot(way); distance < least) {
        least = distance;
        nearest = &all.getContactPoint(i);
      }
    }
    return nearest;
  }
};

}  // namespace limpid
