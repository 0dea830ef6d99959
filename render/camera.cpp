#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limpid {

namespace {

constexpr double kFieldOfView = 32 * std::numbers::pi / 180;  // vertical; calm perspective
constexpr double kNearest = 0.05, kFarthest = 20;             // eye to target [m]
constexpr double kTransition = 0.35;                          // [s]
constexpr double kRoom = 1.0;                                 // around what is framed
// Straight down is allowed to the last thousandth: there "up" would have no direction.
constexpr double kSteepest = std::numbers::pi / 2 - 1e-3;

Vec3 toward_eye(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

// The representative of `angle` that is nearest to `reference`.
double nearest_turn(double angle, double reference) {
  return reference + std::remainder(angle - reference, 2 * std::numbers::pi);
}

}  // namespace

Camera::Camera() : tan_y_(std::tan(kFieldOfView / 2)) {}

void Camera::resize(double width, double height) {
  width_ = std::max(1.0, width);
  height_ = std::max(1.0, height);
}

void Camera::move_now(const Placement& placement) {
  now_ = goal_ = from_ = placement;
  progress_ = 1;
}

void Camera::go_to(const Placement& placement) {
  from_ = now_;
  goal_ = placement;
  goal_.azimuth = nearest_turn(goal_.azimuth, from_.azimuth);
  progress_ = 0;
}

void Camera::orbit(double dx, double dy) {
  constexpr double kRadiansPerPixel = 0.006;
  Placement p = now_;
  p.azimuth -= kRadiansPerPixel * dx;
  p.elevation = std::clamp(p.elevation + kRadiansPerPixel * dy, -kSteepest, kSteepest);
  move_now(p);
}

void Camera::pan(double dx, double dy) {
  const double scale = meters_per_pixel(now_.target);
  Placement p = now_;
  p.target += scale * (dy * up() - dx * right());
  move_now(p);
}

void Camera::zoom(double steps, const Eigen::Vector2d& pixel) {
  const Vec3 under_cursor = plane_drag(pixel, now_.target);
  Placement p = now_;
  p.distance = std::clamp(p.distance * std::pow(0.88, steps), kNearest, kFarthest);
  p.target = under_cursor + (p.distance / now_.distance) * (now_.target - under_cursor);
  move_now(p);
}

void Camera::look(View view) {
  constexpr double kRight = std::numbers::pi / 2;
  Placement p = goal_;
  switch (view) {
    case View::front: p.azimuth = 0, p.elevation = 0; break;
    case View::side: p.azimuth = -kRight, p.elevation = 0; break;
    case View::top: p.azimuth = -kRight, p.elevation = kSteepest; break;
    case View::iso: p.azimuth = Placement{}.azimuth, p.elevation = Placement{}.elevation; break;
  }
  go_to(p);
}

void Camera::frame(const Bounds& bounds) {
  if (bounds.isEmpty()) return;
  Placement p = goal_;
  p.target = bounds.center();
  const Vec3 back = toward_eye(p.azimuth, p.elevation);
  const Vec3 side(-std::sin(p.azimuth), std::cos(p.azimuth), 0);
  const Vec3 top = back.cross(side);
  const double tan_y = tan_y_, tan_x = tan_y * width_ / height_;
  double distance = kNearest;
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = bounds.corner(static_cast<Bounds::CornerType>(i)) - p.target;
    const double needed = std::max(std::abs(d.dot(side)) / tan_x, std::abs(d.dot(top)) / tan_y);
    distance = std::max(distance, d.dot(back) + kRoom * needed);
  }
  p.distance = std::min(distance, kFarthest);
  go_to(p);
}

void Camera::reset(const Bounds& bounds) {
  look(View::iso);
  frame(bounds);
}

void Camera::advance(double dt) {
  if (progress_ >= 1) return;
  progress_ = std::min(1.0, progress_ + dt / kTransition);
  const double s = progress_ * progress_ * (3 - 2 * progress_);  // starts and stops at rest
  now_.target = from_.target + s * (goal_.target - from_.target);
  now_.azimuth = std::lerp(from_.azimuth, goal_.azimuth, s);
  now_.elevation = std::lerp(from_.elevation, goal_.elevation, s);
  now_.distance = from_.distance * std::pow(goal_.distance / from_.distance, s);
}

void Camera::finish() { move_now(goal_); }

Vec3 Camera::forward() const { return -toward_eye(now_.azimuth, now_.elevation); }
Vec3 Camera::right() const { return {-std::sin(now_.azimuth), std::cos(now_.azimuth), 0}; }
Vec3 Camera::up() const { return right().cross(forward()); }
Vec3 Camera::eye() const { return now_.target - now_.distance * forward(); }

Eigen::Matrix4d Camera::view() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.block<1, 3>(0, 0) = right().transpose();
  m.block<1, 3>(1, 0) = up().transpose();
  m.block<1, 3>(2, 0) = -forward().transpose();
  m.block<3, 1>(0, 3) = -m.block<3, 3>(0, 0) * eye();
  return m;
}

Eigen::Matrix4d Camera::projection() const {
  const double near = 0.05 * now_.distance, far = 4 * now_.distance + 4;
  const double f = 1 / tan_y_;
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = f * height_ / width_;
  m(1, 1) = f;
  m(2, 2) = (far + near) / (near - far);
  m(2, 3) = 2 * far * near / (near - far);
  m(3, 2) = -1;
  return m;
}

std::optional<Eigen::Vector2d> Camera::project(const Vec3& point) const {
  const Eigen::Vector4d clip = projection() * view() * point.homogeneous();
  if (clip.w() <= 0) return std::nullopt;
  return Eigen::Vector2d(0.5 * width_ * (1 + clip.x() / clip.w()),
                         0.5 * height_ * (1 - clip.y() / clip.w()));
}

Ray Camera::ray(const Eigen::Vector2d& pixel) const {
  const double tan_y = tan_y_, tan_x = tan_y * width_ / height_;
  const double x = 2 * pixel.x() / width_ - 1, y = 1 - 2 * pixel.y() / height_;
  return {eye(), (forward() + x * tan_x * right() + y * tan_y * up()).normalized()};
}

Vec3 Camera::plane_drag(const Eigen::Vector2d& pixel, const Vec3& through) const {
  const Ray r = ray(pixel);
  // A point behind the eye has no such plane in sight: drag in the plane of the target instead.
  const double depth = (through - r.origin).dot(forward());
  return r.origin + (depth > 0 ? depth : now_.distance) / r.direction.dot(forward()) * r.direction;
}

double Camera::meters_per_pixel(const Vec3& point) const {
  return 2 * tan_y_ * std::abs((point - eye()).dot(forward())) / height_;
}

Camera Camera::magnified(const Vec3& about, double times, double width, double height) const {
  Camera lens = *this;
  lens.resize(width, height);
  const Vec3 back = eye() - about;
  Placement p;
  p.target = about;
  p.distance = std::max(back.norm(), 1e-3);
  p.azimuth = back.head<2>().norm() > 1e-9 ? std::atan2(back.y(), back.x()) : now_.azimuth;
  p.elevation =
      std::clamp(std::asin(std::clamp(back.z() / p.distance, -1.0, 1.0)), -kSteepest, kSteepest);
  lens.move_now(p);
  lens.tan_y_ = meters_per_pixel(about) * lens.height_ / (2 * times * p.distance);
  return lens;
}

}  // namespace limpid
