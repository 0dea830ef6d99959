#include "core/touch/obstacle_distance.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

// Distance of distance_to() alone, without the normal.
double only_distance_to(const Box& box, const Pose& pose, const Vec3& point) {
  const Vec3 p = pose.linear().transpose() * (point - pose.translation());
  const Vec3 out = p.cwiseAbs() - box.size / 2;
  return (out.array() <= 0).all() ? out.maxCoeff() : out.cwiseMax(0).norm();
}

Vec3 in_frame(const Pose& pose, const Vec3& point) {
  return pose.linear().transpose() * (point - pose.translation());
}

// Distances beyond the side and beyond the nearer face; negative: within.
Eigen::Vector2d beyond(const Cylinder& cylinder, const Vec3& p) {
  return {p.head<2>().norm() - cylinder.radius, std::abs(p.z()) - cylinder.length / 2};
}

double only_distance_to(const Cylinder& cylinder, const Pose& pose, const Vec3& point) {
  const Eigen::Vector2d out = beyond(cylinder, in_frame(pose, point));
  return (out.array() <= 0).all() ? out.maxCoeff() : out.cwiseMax(0).norm();
}

// Vector from the nearest point of the capsule's axis, in its frame.
Vec3 from_axis(const Capsule& capsule, const Vec3& p) {
  return p - std::clamp(p.z(), -capsule.length / 2, capsule.length / 2) * Vec3::UnitZ();
}

double only_distance_to(const Capsule& capsule, const Pose& pose, const Vec3& point) {
  return from_axis(capsule, in_frame(pose, point)).norm() - capsule.radius;
}

// Golden-section search along the segment, on which the distance to a convex body is convex.
template <class S>
Vec3 search_segment(const S& shape, const Pose& pose, const Vec3& from, const Vec3& to) {
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double s) { return Vec3(from + s * (to - from)); };
  const auto distance = [&](double s) { return only_distance_to(shape, pose, at(s)); };
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

Surface distance_to(const Cylinder& cylinder, const Pose& pose, const Vec3& point) {
  const Vec3 p = in_frame(pose, point);
  const Eigen::Vector2d out = beyond(cylinder, p);
  const double r = p.head<2>().norm();
  const Vec3 away = r > 0 ? Vec3(p.x() / r, p.y() / r, 0) : Vec3(Vec3::UnitX());
  const Vec3 up(0, 0, p.z() < 0 ? -1 : 1);
  if ((out.array() <= 0).all()) {  // inside: the side or the nearer face
    return {out.maxCoeff(), pose.linear() * (out[0] > out[1] ? away : up)};
  }
  const Eigen::Vector2d part = out.cwiseMax(0);
  const double distance = part.norm();
  return {distance, pose.linear() * (part[0] * away + part[1] * up) / distance};
}

Surface distance_to(const Capsule& capsule, const Pose& pose, const Vec3& point) {
  const Vec3 out = from_axis(capsule, in_frame(pose, point));
  const double r = out.norm();
  return {r - capsule.radius, pose.linear() * (r > 0 ? Vec3(out / r) : Vec3(Vec3::UnitX()))};
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
  return search_segment(box, pose, from, to);
}

Vec3 nearest_on_segment(const Cylinder& cylinder, const Pose& pose, const Vec3& from,
                        const Vec3& to) {
  return search_segment(cylinder, pose, from, to);
}

Vec3 nearest_on_segment(const Capsule& capsule, const Pose& pose, const Vec3& from,
                        const Vec3& to) {
  return search_segment(capsule, pose, from, to);
}

}  // namespace limpid
