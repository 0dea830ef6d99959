#include "core/touch/world_joint.h"

#include <algorithm>

namespace limpid {

void WorldJoint::prepare(Bodies& bodies) {
  BodyMotion& body = bodies[a];
  along.hit.begin(body.of_joint(), body.joint(), body.joint_rate(), body.theta(), along.stop,
                  bodies.T);
  body.push_joint(along.sum());
}

double WorldJoint::solve(Bodies& bodies) {
  BodyMotion& body = bodies[a];
  AlongJoint now{body.joint(), body.joint_speed(), body.joint_answer()};
  const double change = sweep_joint(body.of_joint(), body.potential(), bodies.T, now, along);
  body.set_joint_speed(now.speed);
  return change;
}

double WorldJoint::made(const Bodies& bodies) const {
  const BodyMotion& body = bodies[a];
  return limpid::made(body.of_joint(), body.potential(), bodies.T,
                      {body.joint(), body.joint_speed(), 0}, along);
}

void WorldJoint::finish(Bodies& bodies) {
  const BodyMotion& body = bodies[a];
  along.anchor = -along.friction / stiffness(bodies);
  along.hit.finish(body.of_joint(), body.joint(), bodies.T * body.joint_speed());
  if (along.presses()) bodies.press(a);
}

void WorldJoint::add(Bodies& bodies, const Vec3& more) {
  along.potential += more[0];
  along.stop += more[1];
  along.friction += more[2];
  const double change = more[0] + more[1] + more[2];
  if (change != 0) bodies[a].push_joint(change);
}

// Without the potential, which is the body's own.
double WorldJoint::energy(const Bodies& bodies) const {
  const BodyMotion& body = bodies[a];
  const BodyJoint& joint = body.of_joint();
  const double d = std::max({0.0, joint.low - body.joint(), body.joint() - joint.high});
  return 0.5 * joint.stop_stiffness * (d * d + along.anchor * along.anchor);
}

}  // namespace limpid
