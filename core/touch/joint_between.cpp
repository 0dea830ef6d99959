#include "core/touch/joint_between.h"

#include <algorithm>

#include "core/math/elementary.h"

namespace limpid {

JointBetween::JointBetween(const Bodies& bodies, int body, int to, std::span<JointLink> held)
    : a(body), b(to), links(held) {
  joint.joint = *bodies.about[Bodies::at(body)].joint;
  joint.potential = JointPotential(joint.joint.force);
  const Vec3& along = joint.joint.axis;
  const Pose there = to == BodyContact::kStill ? Pose::Identity() : bodies[to].pose();
  axis = there.linear().transpose() * along;
  across_b = there.linear().transpose() * along.unitOrthogonal();
  across_a = bodies[body].pose().linear().transpose() * along.unitOrthogonal();
  center = there.inverse() * bodies[body].center();
}

void JointBetween::prepare(Bodies& bodies) {
  follow(bodies);
  const Vec3 now = bodies.directed(b, axis);
  joint.along = (now + 0.5 * bodies.T * bodies.spin(b).cross(now)).normalized();
  const Vec3 at = bodies[a].center();
  end_a = bodies.end_at(a, at);
  end_b = bodies.end_at(b, at);
  find_answer(bodies);
  meet(bodies, at);
  push(bodies, joint.force());
}

// Stiff links tremble from tick to tick: the speed that counts is without what they stretch by.
void JointBetween::meet(const Bodies& bodies, const Vec3& at) {
  if (!joint.has_stops()) return;
  JointAnswer::Numbers stretching = JointAnswer::Numbers::Zero();
  for (std::size_t i = 0; i < links.size(); ++i) {
    stretching.segment<3>(3 * static_cast<Eigen::Index>(i)) = links[i].stretching(bodies);
  }
  const Vec3 all = joint.turns() ? Vec3(bodies.spin(a) - bodies.spin(b))
                                 : Vec3(bodies.speed_at(a, at) - bodies.speed_at(b, at));
  const Vec3 rate = all - answer.yield.transpose() * stretching;
  joint.meet(bodies.T, rate, bodies[bodies.moves(a) ? a : b].theta());
}

void JointBetween::turn(Bodies& bodies) {
  push(bodies, -joint.force());
  if (joint.turns() && bodies.moves(b)) {
    const BodyMotion& motion = bodies[b];
    const Vec3 now = bodies.directed(b, axis);
    joint.along = motion.middle(motion.turns_at() + now, bodies.T).normalized();
  }
  find_answer(bodies);
  push(bodies, joint.force());
}

void JointBetween::find_answer(const Bodies& bodies) {
  JointSide one, two;
  if (bodies.moves(a)) one.answer = bodies[a].answer();
  if (bodies.moves(b)) two.answer = bodies[b].answer();
  one.lever = end_a.lever;
  two.lever = end_b.lever;
  std::array<JointHold, 3> holds;
  for (std::size_t i = 0; i < links.size(); ++i) {
    one.links[i] = links[i].force.end_a.lever;
    two.links[i] = links[i].force.end_b.lever;
    holds[i] = {links[i].point.push(bodies.T), links[i].held};
  }
  answer = joint_answer(joint.turns(), one, two, {holds.data(), links.size()});
  joint.start(answer.response);
}

// Solves its links, and then its own force with the links' forces that follow from it: one after
// the other they would not settle where masses are unlike.
double JointBetween::solve(Bodies& bodies) {
  JointAnswer::Numbers left = JointAnswer::Numbers::Zero();
  for (std::size_t i = 0; i < links.size(); ++i) {
    left.segment<3>(3 * static_cast<Eigen::Index>(i)) = links[i].left(bodies);
  }
  const double linked = add_to_links(bodies, -answer.give * left);
  const Vec3 before = joint.force();
  joint.forces.hit.trembling = joint.forces.hit.holds ? joint.along.dot(trembling(bodies)) : 0;
  const double change = joint.sweep(bodies.T, speed(bodies));
  const Vec3 more = joint.force() - before;
  push(bodies, more);
  add_to_links(bodies, -answer.yield * more);
  return std::max(linked, change);
}

// The part of the relative velocity that its links' stretching makes.
Vec3 JointBetween::trembling(const Bodies& bodies) const {
  JointAnswer::Numbers stretching = JointAnswer::Numbers::Zero();
  for (std::size_t i = 0; i < links.size(); ++i) {
    stretching.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        links[i].held * links[i].force.speed(bodies);
  }
  return answer.yield.transpose() * stretching;
}

double JointBetween::add_to_links(Bodies& bodies, const JointAnswer::Numbers& more) {
  double most = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Vec3 of_it = more.segment<3>(3 * static_cast<Eigen::Index>(i));
    links[i].add(bodies, of_it);
    most = std::max(most, of_it.norm());
  }
  return most;
}

void JointBetween::finish(Bodies& bodies) {
  if (joint.presses()) {
    bodies.press(a);
    bodies.press(b);
  }
  if (bodies.moves(a) || bodies.moves(b)) joint.finish(bodies.T, speed(bodies));
}

void JointBetween::follow(const Bodies& bodies) {
  if (joint.ball()) return;
  const Vec3 now = bodies.directed(b, axis);
  if (!joint.turns()) {
    const Vec3 way = bodies[a].center() - bodies.place(b, center);
    joint.follow(now.dot(way) - joint.place);
    return;
  }
  const Vec3 start = bodies.directed(b, across_b);
  const SineCosine turn = sine_cosine(joint.place);
  const Vec3 expected = turn.cosine * start + turn.sine * now.cross(start);
  joint.follow(now.dot(expected.cross(bodies.directed(a, across_a))));
}

Vec3 JointBetween::speed(const Bodies& bodies) const {
  if (!joint.turns()) return bodies.velocity(end_a) - bodies.velocity(end_b);
  const auto turning = [&](int body) {
    return bodies.moves(body) ? bodies[body].turning() : Vec3(Vec3::Zero());
  };
  return turning(a) - turning(b);
}

void JointBetween::push(Bodies& bodies, const Vec3& force) const {
  if (!joint.turns()) return bodies.apply(end_a, end_b, force);
  if (force.isZero(0)) return;
  bodies.twist(a, force);
  bodies.twist(b, -force);
}

}  // namespace limpid
