#include <algorithm>
#include <cmath>

#include "core/touch/contacts.h"

namespace limpid {
namespace {

// distance_to() without its normal.
double only_distance_to(const Box& box, const Pose& pose, const Vec3& point) {
  const Vec3 p = pose.linear().transpose() * (point - pose.translation());
  const Vec3 out = p.cwiseAbs() - box.size / 2;
  return (out.array() <= 0).all() ? out.maxCoeff() : out.cwiseMax(0).norm();
}

}  // namespace

Surface distance_to(const Plane& plane, const Pose& pose, const Vec3& point) {
  return {plane.normal.dot(point - pose.translation()), plane.normal};
}

Surface distance_to(const Sphere& sphere, const Pose& pose, const Vec3& point) {
  const Vec3 out = point - pose.translation();
  const double r = out.norm();
  return {r - sphere.radius, r > 0 ? Vec3(out / r) : Vec3(Vec3::UnitZ())};
}

Surface distance_to(const Box& box, const Pose& pose, const Vec3& point) {
  const Vec3 p = pose.linear().transpose() * (point - pose.translation());
  const Vec3 out = p.cwiseAbs() - box.size / 2;
  if ((out.array() <= 0).all()) {  // inside: the nearest face
    Eigen::Index axis = 0;
    const double distance = out.maxCoeff(&axis);
    const double sign = p[axis] < 0 ? -1 : 1;
    return {distance, sign * pose.linear().col(axis)};
  }
  const Vec3 beyond = out.cwiseMax(0);
  const double distance = beyond.norm();
  const Vec3 signs = p.unaryExpr([](double c) { return c < 0 ? -1.0 : 1.0; });
  return {distance, pose.linear() * beyond.cwiseProduct(signs) / distance};
}

Vec3 nearest_on_segment(const Plane& plane, const Pose&, const Vec3& from, const Vec3& to) {
  return plane.normal.dot(to - from) < 0 ? to : from;
}

Vec3 nearest_on_segment(const Sphere&, const Pose& pose, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  if (length2 == 0) return from;
  return from + std::clamp(along.dot(pose.translation() - from) / length2, 0.0, 1.0) * along;
}

Vec3 nearest_on_segment(const Box& box, const Pose& pose, const Vec3& from, const Vec3& to) {
  // The distance to a convex body is convex along the segment: golden-section search.
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double s) { return Vec3(from + s * (to - from)); };
  const auto distance = [&](double s) { return only_distance_to(box, pose, at(s)); };
  double low = 0, high = 1;
  double a = high - kGolden, b = low + kGolden;
  double at_a = distance(a), at_b = distance(b);
  for (int i = 0; i < 40; ++i) {
    if (at_a <= at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = distance(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = distance(b);
    }
  }
  return at((low + high) / 2);
}

}  // namespace limpid
