#include "app/experiments/body_theory.h"

#include <cmath>
#include <limits>

namespace limpid {

Vec3 ball_moments(double mass, double radius) {
  return Vec3::Constant(0.4 * mass * radius * radius);
}

Vec3 box_moments(double mass, const Vec3& size) {
  const Vec3 squares = size.cwiseProduct(size);
  return mass / 12 * (Vec3::Constant(squares.sum()) - squares);
}

Vec3 cylinder_moments(double mass, double radius, double length) {
  const double r2 = radius * radius, across = mass * (r2 / 4 + length * length / 12);
  return {across, across, mass * r2 / 2};
}

Vec3 capsule_moments(double mass, double radius, double length) {
  const double r2 = radius * radius;
  const double of_middle = length / (length + 4 * radius / 3);  // part of the volume
  const double balls = mass * (1 - of_middle);
  // Both half balls, as one ball that was cut and moved apart by the length.
  const double apart = balls * (0.4 * r2 + length * length / 4 + 3 * length * radius / 8);
  const Vec3 middle = cylinder_moments(mass * of_middle, radius, length);
  return middle + Vec3(apart, apart, 0.4 * balls * r2);
}

double sliding(double slope, double friction) {
  return kStandardGravity * (std::sin(slope) - friction * std::cos(slope));
}

double rolling(double slope, double mass, double radius, double I) {
  return kStandardGravity * std::sin(slope) / (1 + I / (mass * radius * radius));
}

double tipping(double width, double height) { return std::atan2(width, height); }

double pendulum_period(double mass, double to_center, double I, double amplitude) {
  const double slowness = std::sqrt(I / (mass * kStandardGravity * to_center));
  return 4 * slowness * std::comp_ellint_1(std::sin(amplitude / 2));
}

double precession(double mass, double to_center, double I, double spin) {
  return mass * kStandardGravity * to_center / (I * spin);
}

double braked_way(double mass, double damping, double speed, double time) {
  return speed * mass / damping * -std::expm1(-damping / mass * time);
}

double drawn_way(double mass, double damping, double stiffness, double rest, double time) {
  const double middle = damping / (2 * mass);
  const double apart = std::sqrt(middle * middle - stiffness / mass);
  const double quick = middle + apart, slow = stiffness / (mass * quick);
  return rest *
         (1 - (quick * std::exp(-slow * time) - slow * std::exp(-quick * time)) / (quick - slow));
}

Vec3 FreeSpin::change(const Vec3& w) const { return I_.cwiseProduct(w).cross(w).cwiseQuotient(I_); }

double FreeSpin::turned_over(int n, double longest) {
  while (time_ < longest) {
    const Vec3 a = change(w_), b = change(w_ + step_ / 2 * a), c = change(w_ + step_ / 2 * b),
               d = change(w_ + step_ * c);
    const double before = w_.x();
    w_ += step_ / 6 * (a + 2 * b + 2 * c + d);
    time_ += step_;
    if (before * w_.x() < 0 && --n == 0) return time_ - step_ * w_.x() / (w_.x() - before);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void BallsAndWall::meet() {
  const double all = mass[0] + mass[1];
  const double together = momentum() / all, parting = restitution * (speed[0] - speed[1]);
  speed = {together - parting * mass[1] / all, together + parting * mass[0] / all};
}

void BallsAndWall::meet_to_the_end() {
  for (;;) {
    if (speed[0] > speed[1]) {
      meet();
    } else if (speed[1] > 0) {
      speed[1] *= -restitution;
    } else {
      return;
    }
  }
}

double BallsAndWall::energy() const {
  return (mass[0] * speed[0] * speed[0] + mass[1] * speed[1] * speed[1]) / 2;
}

double BallsAndWall::momentum() const { return mass[0] * speed[0] + mass[1] * speed[1]; }

}  // namespace limpid
