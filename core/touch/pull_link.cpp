#include "core/touch/pull_link.h"

namespace limpid {

void PullLink::prepare(Bodies& bodies) {
  const Vec3 at = bodies.place(a, pull.point);
  force.end_a = bodies.end_at(a, at);
  point.stretch = at - pull.target;
  const double length = point.stretch.norm();
  if (length > kLongest) point.stretch *= kLongest / length;
  const double mass = bodies.about[Bodies::at(a)].mass;
  point.K = mass * kSwing * kSwing;
  point.B = 2 * mass * kSwing;
  point.yield(bodies.T, bodies.answer(force.end_a));
}

}  // namespace limpid
