#include "core/dynamics/contacts.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

// Further apart than this nothing touches within one tick [m].
constexpr double kReach = 0.02;

}  // namespace

Surface distance_to(const Plane& plane, const Vec3& point) {
  return {plane.normal.dot(point - plane.point), plane.normal};
}

Surface distance_to(const Sphere& sphere, const Vec3& point) {
  const Vec3 out = point - sphere.center;
  const double r = out.norm();
  return {r - sphere.radius, r > 0 ? Vec3(out / r) : Vec3(Vec3::UnitZ())};
}

Surface distance_to(const Box& box, const Vec3& point) {
  const Vec3 p = box.pose.linear().transpose() * (point - box.pose.translation());
  const Vec3 out = p.cwiseAbs() - box.size / 2;
  if ((out.array() <= 0).all()) {  // inside: the nearest face
    Eigen::Index axis = 0;
    const double distance = out.maxCoeff(&axis);
    const double sign = p[axis] < 0 ? -1 : 1;
    return {distance, sign * box.pose.linear().col(axis)};
  }
  const Vec3 beyond = out.cwiseMax(0);
  const double distance = beyond.norm();
  const Vec3 signs = p.unaryExpr([](double c) { return c < 0 ? -1.0 : 1.0; });
  return {distance, box.pose.linear() * beyond.cwiseProduct(signs) / distance};
}

Vec3 nearest_on_segment(const Plane& plane, const Vec3& from, const Vec3& to) {
  return plane.normal.dot(to - from) < 0 ? to : from;
}

Vec3 nearest_on_segment(const Sphere& sphere, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length2 = along.squaredNorm();
  if (length2 == 0) return from;
  return from + std::clamp(along.dot(sphere.center - from) / length2, 0.0, 1.0) * along;
}

Vec3 nearest_on_segment(const Box& box, const Vec3& from, const Vec3& to) {
  // The distance to a convex body is convex along the segment: golden-section search.
  constexpr double kGolden = 0.6180339887498949;
  const auto at = [&](double s) { return Vec3(from + s * (to - from)); };
  const auto distance = [&](double s) { return distance_to(box, at(s)).distance; };
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

template <int N>
Contacts<N>::Contacts(const ArmDescription& arm, const Scene& scene) : scene_(scene) {
  const Vec3 tip = arm.tip.translation();
  probes_.push_back({"tip", arm.dof() - 1, tip, tip, scene.tip_radius});
  probes_.insert(probes_.end(), scene.probes.begin(), scene.probes.end());
  const std::size_t obstacles = scene.planes.size() + scene.spheres.size() + scene.boxes.size();
  Contact<N> empty;
  empty.gradient = Vec<N>::Zero(arm.dof());
  contacts_.assign(obstacles * probes_.size() + scene.joint_contacts.size(), empty);
}

template <int N>
void Contacts<N>::add(double depth, double stiffness, const Vec3& point, const Vec3& normal,
                      int link, const Arm<N>& arm, const typename Arm<N>::Frames& f) {
  Contact<N>& c = contacts_[count_++];
  c.depth = depth;
  c.stiffness = stiffness;
  c.point = point;
  c.normal = normal;
  Jacobian<N> J;
  arm.point_jacobian(f, link, point, J);
  c.gradient.noalias() = -J.transpose() * normal;
}

template <int N>
void Contacts<N>::find(const Arm<N>& arm, const typename Arm<N>::Frames& f, const Vec<N>& x) {
  count_ = 0;
  for (const Probe& probe : probes_) {
    const Vec3 from = Arm<N>::point(f, probe.link, probe.from);
    const Vec3 to = Arm<N>::point(f, probe.link, probe.to);
    const auto touch = [&](const auto& obstacle) {
      const Vec3 point = from == to ? from : nearest_on_segment(obstacle, from, to);
      const Surface s = distance_to(obstacle, point);
      const double depth = probe.radius - s.distance;
      if (depth > -kReach) {
        add(depth, obstacle.stiffness, point, s.normal, probe.link, arm, f);
      }
    };
    for (const Plane& plane : scene_.planes) touch(plane);
    for (const Sphere& sphere : scene_.spheres) touch(sphere);
    for (const Box& box : scene_.boxes) touch(box);
  }
  for (const JointContact& stop : scene_.joint_contacts) {
    Contact<N>& c = contacts_[count_++];
    c.depth = stop.direction * (x[stop.joint] - stop.angle);
    c.gradient.setZero();
    c.gradient[stop.joint] = stop.direction;
    c.stiffness = stop.stiffness;
    c.point = f.p[static_cast<std::size_t>(stop.joint)];
    c.normal.setZero();
  }
}

template <int N>
double Contacts<N>::potential() const {
  double U = 0;
  for (const Contact<N>& c : list()) {
    const double d = std::max(c.depth, 0.0);
    U += 0.5 * c.stiffness * d * d;
  }
  return U;
}

template class Contacts<3>;
template class Contacts<kAnyDof>;

}  // namespace limpid
