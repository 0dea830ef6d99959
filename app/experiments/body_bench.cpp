#include "app/experiments/body_bench.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace limpid {

double BodyClaim::error() const {
  if (!expected) return measured;
  return relative ? 100 * (measured / *expected - 1) : measured - *expected;
}

Check BodyClaim::check() const {
  const std::string of =
      !expected ? fmt::format(" [{}]", unit) : fmt::format(": error [{}]", relative ? "%" : unit);
  Check check = at_most(what + of, std::abs(error()), limit);
  check.against = Comparison{expected, measured, unit, conditions};
  check.unjudged = unjudged;
  return check;
}

std::string tick_text(double tick) { return fmt::format("tick {:.4g} ms", 1e3 * tick); }

const Object& BodyBench::object(int body) const {
  for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
    if (world_.body_of(i) == body) return scene_.objects[i];
  }
  throw std::out_of_range("no such body");
}

void BodyBench::step() {
  for (int i = 0; awake_ && i < world_.count(); ++i) world_.touch(i);
  world_.begin(tick_);
  world_.settle();
  world_.finish();
  ++ticks_;
}

void BodyBench::run(double seconds, const std::function<void()>& after_tick) {
  for (long left = std::lround(seconds / tick_); left > 0; --left) {
    step();
    if (after_tick) after_tick();
  }
}

Vec3 BodyBench::own_spin(int body) const {
  return world_.pose(body).linear().transpose() * world_.spin(body);
}

double BodyBench::energy(int body, const Vec3& moments) const {
  const double m = object(body).body->mass;
  const Vec3 w = own_spin(body);
  return m * world_.speed(body).squaredNorm() / 2 + w.dot(moments.cwiseProduct(w)) / 2 -
         m * scene_.gravity.dot(world_.center(body));
}

Vec3 BodyBench::angular_momentum(int body, const Vec3& moments) const {
  return world_.pose(body).linear() * moments.cwiseProduct(own_spin(body));
}

Object moving(const std::string& name, const Shape& shape, double mass, const Pose& pose) {
  Object object;
  object.name = name;
  object.shape = shape;
  object.pose = pose;
  object.body = Body{};
  object.body->mass = mass;
  return object;
}

Object ground(double slope, double friction) {
  Object object;
  object.name = "ground";
  object.shape = Plane{Vec3(std::sin(slope), 0, std::cos(slope))};
  object.material.friction_static = object.material.friction_kinetic = friction;
  return object;
}

Pose turned_at(const Vec3& at, double angle, const Vec3& about) {
  Pose pose = pose_at(at);
  pose.linear() = Eigen::AngleAxisd(angle, about).toRotationMatrix();
  return pose;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

}  // namespace limpid
