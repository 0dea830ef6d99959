#include "core/touch/spring_link.h"

#include <Eigen/LU>
#include <algorithm>

namespace limpid {

void SpringLink::prepare(Bodies& bodies) {
  const Vec3 at_a = bodies.place(a, on_a), at_b = bodies.place(b, on_b);
  force.end_a = bodies.end_at(a, at_a);
  force.end_b = bodies.end_at(b, at_b);
  apart = at_a - at_b;
  W = force.answer(bodies);
  force.apply(bodies);
}

// A discrete gradient of the spring's energy (LaBudde and Greenspan 1976): over a tick in which its
// length goes from r to r', the force -k (1 - 2 L/(r + r')) d in the middle d of both places takes
// what the spring gains, however it turns, and has no torque about it. The damper is along d.
SpringLink::Pull SpringLink::pull(const Vec3& speed, double T) const {
  const Vec3 middle = apart + 0.5 * T * speed;
  const double lengths = apart.norm() + (apart + T * speed).norm(), away = middle.norm();
  if (!(lengths > 0)) return {};
  const double k = spring.stiffness * (1 - 2 * spring.length / lengths);
  const Vec3 along = away > 0 ? Vec3(middle / away) : Vec3(Vec3::Zero());
  const Mat3 onto = along * along.transpose();
  Pull p{-k * middle - spring.damping * along * along.dot(speed)};
  p.slope = (0.5 * T * spring.stiffness + spring.damping) * onto +
            0.5 * T * std::max(0.0, k) * (Mat3::Identity() - onto);
  return p;
}

double SpringLink::solve(Bodies& bodies) {
  const Pull now = pull(force.speed(bodies), bodies.T);
  const Mat3 yields = Mat3::Identity() + now.slope * W;
  return force.set(bodies, force.on_a + yields.inverse() * (now.force - force.on_a));
}

double SpringLink::turn(Bodies& bodies) {
  const Vec3 before = force.speed(bodies);
  force.turn(bodies, bodies.place(a, on_a), bodies.place(b, on_b));
  W = force.answer(bodies);
  return bodies.T * (force.speed(bodies) - before).norm();
}

double SpringLink::made(const Bodies& bodies) const {
  const Vec3 way = bodies.T * force.speed(bodies);
  const double before = apart.norm() - spring.length, after = (apart + way).norm() - spring.length;
  return force.on_a.dot(way) + 0.5 * spring.stiffness * (after - before) * (after + before);
}

void SpringLink::finish(const Bodies&) {
  if (!(force.on_a.norm() > spring.breaks_at)) return;
  broken = true;
  force.on_a.setZero();
}

double SpringLink::energy(const Bodies& bodies) const {
  const double x = (bodies.place(a, on_a) - bodies.place(b, on_b)).norm();
  return 0.5 * spring.stiffness * (x - spring.length) * (x - spring.length);
}

}  // namespace limpid
