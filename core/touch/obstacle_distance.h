// Distances between points, segments and plain shapes.
#pragma once

#include "core/touch/scene.h"

namespace limpid {

// Signed distance of a point to the surface, negative inside, and the outward normal there.
struct Surface {
  double distance;  // [m]
  Vec3 normal;
};
Surface distance_to(const Plane& plane, const Pose& pose, const Vec3& point);
Surface distance_to(const Sphere& sphere, const Pose& pose, const Vec3& point);
Surface distance_to(const Box& box, const Pose& pose, const Vec3& point);
Surface distance_to(const Cylinder& cylinder, const Pose& pose, const Vec3& point);
Surface distance_to(const Capsule& capsule, const Pose& pose, const Vec3& point);

// Point of the segment from-to nearest to a shape.
Vec3 nearest_on_segment(const Plane& plane, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Sphere& sphere, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Box& box, const Pose& pose, const Vec3& from, const Vec3& to);
Vec3 nearest_on_segment(const Cylinder& cylinder, const Pose& pose, const Vec3& from,
                        const Vec3& to);
Vec3 nearest_on_segment(const Capsule& capsule, const Pose& pose, const Vec3& from, const Vec3& to);

}  // namespace limpid
