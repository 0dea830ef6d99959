#include "app/desktop/scene/transform.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "app/desktop/scene/scene_editor.h"

namespace limpid {
namespace {

constexpr double kStep = 0.005, kAngleStep = std::numbers::pi / 12, kFactorStep = 0.1;
constexpr double kLeastFactor = 0.02, kMostFactor = 50;
constexpr double kNearest = 8;  // least distance to the pivot for scaling [px]

double whole(double number, double step, bool steps) {
  return steps ? step * std::round(number / step) : number;
}

// Returns how far along the line through `through` the mouse is [m]; nothing if the line points at
// the eye.
std::optional<double> along(const Ray& ray, const Vec3& through, const Vec3& direction) {
  const Vec3 off = through - ray.origin;
  const double slant = direction.dot(ray.direction);
  const double apart = 1 - slant * slant;
  if (apart < 1e-4) return std::nullopt;
  return (slant * off.dot(ray.direction) - off.dot(direction)) / apart;
}

// Returns the mouse's angle about the pivot, anticlockwise as the eye sees it [rad].
double angle_of(const Eigen::Vector2d& pixel, const Eigen::Vector2d& middle) {
  return std::atan2(middle.y() - pixel.y(), pixel.x() - middle.x());
}

void scale(Sphere& sphere, double factor, std::optional<int>) { sphere.radius *= factor; }
void scale(Box& box, double factor, std::optional<int> axis) {
  for (int i = 0; i < 3; ++i) {
    if (!axis || axis == i) box.size[i] *= factor;
  }
}
template <class Tube>
void scale_tube(Tube& tube, double factor, std::optional<int> axis) {
  if (axis != 2) tube.radius *= factor;
  if (!axis || axis == 2) tube.length *= factor;
}
void scale(Cylinder& cylinder, double factor, std::optional<int> axis) {
  scale_tube(cylinder, factor, axis);
}
void scale(Capsule& capsule, double factor, std::optional<int> axis) {
  scale_tube(capsule, factor, axis);
}
void scale(Mesh& mesh, double factor, std::optional<int>) { mesh.scale *= factor; }
void scale(Plane&, double, std::optional<int>) {}
void scale(JointStop&, double, std::optional<int>) {}

}  // namespace

bool can(TransformKind kind, const Object& object) {
  if (has_shape<JointStop>(object)) return false;
  switch (kind) {
    case TransformKind::move: return true;
    case TransformKind::turn: return !has_shape<Sphere>(object) || object.body.has_value();
    case TransformKind::scale: return !has_shape<Plane>(object);
  }
  return false;
}

Transform::Transform(TransformKind wanted, Object object, const Model* model)
    : kind(wanted), from(std::move(object)) {
  const Bounds box = bounds_of(from, model);
  pivot = has_shape<Mesh>(from) && !box.isEmpty() ? Vec3(box.center()) : from.pose.translation();
}

Vec3 Transform::direction(int i) const {
  return kind == TransformKind::scale ? Vec3(from.pose.linear().col(i)) : Vec3(Vec3::Unit(i));
}

Transform::Result Transform::to(const Camera& camera, const Eigen::Vector2d& begin,
                                const Eigen::Vector2d& now, bool steps) const {
  const auto middle = camera.project(pivot);
  if (!middle) return {from, ""};
  switch (kind) {
    case TransformKind::move: return moved(camera, begin, now, steps);
    case TransformKind::turn:
      return turned(camera, angle_of(now, *middle) - angle_of(begin, *middle), steps);
    case TransformKind::scale:
      return scaled((now - *middle).norm() / std::max((begin - *middle).norm(), kNearest), steps);
  }
  return {from, ""};
}

Transform::Result Transform::moved(const Camera& camera, const Eigen::Vector2d& begin,
                                   const Eigen::Vector2d& now, bool steps) const {
  Object object = from;
  if (!axis) {
    Vec3 way = camera.plane_drag(now, pivot) - camera.plane_drag(begin, pivot);
    for (double& each : way) each = whole(each, kStep, steps);
    object.pose.translation() += way;
    return {object,
            fmt::format("{:.1f}, {:.1f}, {:.1f} mm", 1e3 * way.x(), 1e3 * way.y(), 1e3 * way.z())};
  }
  const Vec3 line = direction(*axis);
  const auto a = along(camera.ray(begin), pivot, line), b = along(camera.ray(now), pivot, line);
  return moved_along(*axis, a && b ? whole(*b - *a, kStep, steps) : 0);
}

Transform::Result Transform::moved_along(int line, double way) const {
  Object object = from;
  object.pose.translation() += way * direction(line);
  return {object,
          fmt::format("{} {:.1f} mm", kAxisNames[static_cast<std::size_t>(line)], 1e3 * way)};
}

Transform::Result Transform::by(const Camera& camera, double amount) const {
  switch (kind) {
    case TransformKind::move: return moved_along(axis.value_or(0), 1e-3 * amount);
    case TransformKind::turn: {
      // Numbers turn about the axis itself, whichever side is looked at.
      const bool from_behind = axis && direction(*axis).dot(camera.forward()) > 0;
      const double angle = amount * std::numbers::pi / 180;
      return turned(camera, from_behind ? -angle : angle, false);
    }
    case TransformKind::scale: return scaled(amount, false);
  }
  return {from, ""};
}

Transform::Result Transform::turned(const Camera& camera, double angle, bool steps) const {
  Object object = from;
  const Vec3 to_eye = -camera.forward();
  const Vec3 line = axis ? direction(*axis) : to_eye;
  if (line.dot(to_eye) < 0) angle = -angle;
  angle = whole(std::remainder(angle, 2 * std::numbers::pi), kAngleStep, steps);
  const Mat3 turn = Eigen::AngleAxisd(angle, line).toRotationMatrix();
  object.pose.translation() = pivot + turn * (from.pose.translation() - pivot);
  if (auto* plane = std::get_if<Plane>(&object.shape)) {
    plane->normal = (turn * plane->normal).normalized();
  } else {
    object.pose.linear() = turn * from.pose.linear();
  }
  return {object, fmt::format("{:.1f}\xC2\xB0", angle * 180 / std::numbers::pi)};
}

Transform::Result Transform::scaled(double factor, bool steps) const {
  Object object = from;
  factor = std::clamp(whole(factor, kFactorStep, steps), kLeastFactor, kMostFactor);
  std::visit([&](auto& shape) { scale(shape, factor, axis); }, object.shape);
  if (has_shape<Mesh>(object)) {  // a mesh's middle need not be its frame's origin
    object.pose.translation() = pivot + factor * (from.pose.translation() - pivot);
  }
  return {object, fmt::format("\xC3\x97{:.2f}", factor)};
}

const char* Transform::what() const {
  switch (kind) {
    case TransformKind::move: return "place";
    case TransformKind::turn: return "rotation";
    case TransformKind::scale: return "size";
  }
  return "";
}

}  // namespace limpid
