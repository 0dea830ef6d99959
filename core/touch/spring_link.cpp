#include "core/touch/spring_link.h"

namespace limpid {

void SpringLink::prepare(Bodies& bodies) {
  const Vec3 at_a = bodies.place(a, on_a), at_b = bodies.place(b, on_b);
  force.end_a = bodies.end_at(a, at_a);
  force.end_b = bodies.end_at(b, at_b);
  const Vec3 apart = at_a - at_b;
  const double length = apart.norm();
  along = length > 0 ? Vec3(apart / length) : Vec3(Vec3::UnitZ());
  stretch = length - spring.length;
  c = along.dot(force.answer(bodies) * along);
  force.on_a = along * along.dot(force.on_a);
  force.apply(bodies);
}

double SpringLink::solve(Bodies& bodies) {
  const double k = spring.stiffness * bodies.T / 2 + spring.damping, before = along.dot(force.on_a);
  const double v0 = along.dot(force.speed(bodies)) - c * before;
  return force.set(bodies, -(spring.stiffness * stretch + k * v0) / (1 + k * c) * along);
}

double SpringLink::made(const Bodies& bodies) const {
  const double way = bodies.T * along.dot(force.speed(bodies));
  return along.dot(force.on_a) * way + spring.stiffness * way * (stretch + way / 2);
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
