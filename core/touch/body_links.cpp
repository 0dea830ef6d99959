// Joints and springs between bodies.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/math/elementary.h"
#include "core/touch/body_world.h"

namespace limpid {
namespace {

// Distance between the points that make a hinge or a slider between bodies [m].
constexpr double kJointArm = 0.01;
// Frequency of the pull's spring, which is critically damped [rad/s].
constexpr double kPullSwing = 25;
constexpr double kLongestPull = 0.04;  // distance beyond which the pull grows no more [m]

}  // namespace

void BodyWorld::add_links(const Scene& scene) {
  for (int i = 0; i < count(); ++i) {
    if (bodies_[at(i)].on_joint() || !of_bodies_[at(i)].joint) continue;
    add_joint(i, *of_bodies_[at(i)].joint);
  }
  for (const BodySpring& spring : scene.springs) {
    Link link;
    link.spring = true;
    link.a = number(spring.between[0]);
    link.b = number(spring.between[1]);
    link.on_a = spring.points[0];
    link.on_b = spring.points[1];
    if (link.a == BodyContact::kStill) {
      std::swap(link.a, link.b);
      std::swap(link.on_a, link.on_b);
    }
    if (link.a == BodyContact::kStill) continue;  // between fixed ends
    link.length = spring.length;
    link.K = spring.stiffness;
    link.B = spring.damping;
    link.breaks_at = spring.breaks_at;
    links_.push_back(link);
  }
}

// Adds a joint's links: a ball joint holds one point; a hinge two on its axis; a slider three, one
// of them off the axis, each free along it.
void BodyWorld::add_joint(int body, const BodyJoint& joint) {
  const Pose& pose = bodies_[at(body)].pose();
  const int to = number(joint.to);
  const Vec3 axis = pose.linear().transpose() * joint.axis;
  const Vec3 across = pose.linear().transpose() * joint.axis.unitOrthogonal();
  const Vec3 center = bodies_[at(body)].center();
  Held held;
  held.joint.joint = joint;
  held.joint.potential = JointPotential(joint.force);
  held.a = body;
  held.b = to;
  held.first = links_.size();
  if (joint.kind == BodyJoint::Kind::ball) {
    add_link(body, to, joint.point, nullptr);
  } else if (joint.kind == BodyJoint::Kind::hinge) {
    add_link(body, to, joint.point + kJointArm * axis, nullptr);
    add_link(body, to, joint.point - kJointArm * axis, nullptr);
  } else {
    for (const Vec3& arm : {axis, Vec3(-axis), across}) {
      add_link(body, to, pose.inverse() * center + kJointArm * arm, &joint.axis);
    }
  }
  if (!HeldJoint::needed(joint)) return;
  const Pose there = to == BodyContact::kStill ? Pose::Identity() : bodies_[at(to)].pose();
  held.links = links_.size() - held.first;
  held.axis = there.linear().transpose() * joint.axis;
  held.across_b = there.linear().transpose() * joint.axis.unitOrthogonal();
  held.across_a = across;
  held.center = there.inverse() * center;
  held_.push_back(held);
}

void BodyWorld::add_link(int body, int to, const Vec3& point, const Vec3* rail_axis) {
  Link link;
  link.a = body;
  link.b = to;
  link.on_a = point;
  const Vec3 there = bodies_[at(body)].pose() * point;
  link.on_b = to == BodyContact::kStill ? there : bodies_[at(to)].pose().inverse() * there;
  link.K = of_bodies_[at(body)].contact_stiffness;
  if (rail_axis != nullptr) {
    link.rail = true;
    link.rail_axis = bodies_[at(to)].pose().linear().transpose() * *rail_axis;
  }
  links_.push_back(link);
}

void BodyWorld::begin_link(Link& link) {
  if (link.broken || (!moves(link.a) && !moves(link.b))) return;
  if (link.rail) {
    begin_rail(link);
    return;
  }
  const Vec3 on_a = place(link.a, link.on_a), on_b = place(link.b, link.on_b);
  link.end_a = end_at(link.a, on_a);
  link.end_b = end_at(link.b, on_b);
  link.stretch = on_a - on_b;
  link.W = answer(link.end_a) + answer(link.end_b);
  if (link.spring) {
    const double length = link.stretch.norm();
    link.along = length > 0 ? Vec3(link.stretch / length) : Vec3(Vec3::UnitZ());
    link.c = link.along.dot(link.W * link.along);
    link.force = link.along * link.along.dot(link.force);
  } else {
    const double m_eff = 3 * BodyMotion::kTheta * T_ / link.W.trace();
    link.B = 2 * damping_ratio(0) * std::sqrt(link.K * m_eff);
    const double k = link.K * T_ / 2 + link.B;
    link.give = k * (Mat3::Identity() + k * link.W).inverse();
  }
  apply(link.end_a, link.end_b, link.force);
}

void BodyWorld::begin_pull() {
  pulling_ = Link{};
  pulling_.a = pull_.body;
  if (!moves(pull_.body)) return;
  const Vec3 on_a = place(pull_.body, pull_.point);
  pulling_.end_a = end_at(pull_.body, on_a);
  pulling_.W = answer(pulling_.end_a);
  pulling_.stretch = on_a - pull_.target;
  const double length = pulling_.stretch.norm();
  if (length > kLongestPull) pulling_.stretch *= kLongestPull / length;
  const double mass = of_bodies_[at(pull_.body)].mass;
  pulling_.K = mass * kPullSwing * kPullSwing;
  pulling_.B = 2 * mass * kPullSwing;
  const double k = pulling_.K * T_ / 2 + pulling_.B;
  pulling_.give = k * (Mat3::Identity() + k * pulling_.W).inverse();
}

// Begins a slider's link: it holds the present place, by the point of the other body that is there
// now.
void BodyWorld::begin_rail(Link& link) {
  const Vec3 on_a = place(link.a, link.on_a);
  link.end_a = end_at(link.a, on_a);
  link.end_b = end_at(link.b, on_a);
  const Vec3 now = directed(link.b, link.rail_axis);
  const Vec3 off = on_a - place(link.b, link.on_b);
  const Vec3 spin = moves(link.b) ? bodies_[at(link.b)].spin() : Vec3(Vec3::Zero());
  const auto later = [&](const Vec3& v) { return Vec3(v + 0.5 * T_ * spin.cross(v)); };
  const Vec3 axis = later(now).normalized();
  // The point on b is the one at a's place in the middle of the tick: otherwise the force and its
  // reaction would turn both.
  const auto speed = [&](int body) {
    if (!moves(body)) return Vec3(Vec3::Zero());
    const BodyMotion& motion = bodies_[at(body)];
    return Vec3(motion.speed() + motion.spin().cross(on_a - motion.center()));
  };
  link.end_b.lever += 0.5 * T_ * axis * axis.dot(speed(link.a) - speed(link.b));
  link.held = Mat3::Identity() - axis * axis.transpose();
  link.stretch = link.held * later(off - now * now.dot(off));
  const Mat3 W = answer(link.end_a) + answer(link.end_b);
  link.W = link.held * W * link.held;
  const double m_eff = 2 * BodyMotion::kTheta * T_ / link.W.trace();
  link.B = 2 * damping_ratio(0) * std::sqrt(link.K * m_eff);
  const double k = link.K * T_ / 2 + link.B;
  link.give = k * (Mat3::Identity() + k * link.W).inverse() * link.held;
  link.force = link.held * link.force;
  apply(link.end_a, link.end_b, link.force);
}

// Sets the joint's place to that of its sides, from which a tick's own rotation leads it away.
void BodyWorld::follow(Held& held) const {
  if (held.joint.ball()) return;
  const Vec3 axis = directed(held.b, held.axis);
  if (!held.joint.turns()) {
    const Vec3 way = bodies_[at(held.a)].center() - place(held.b, held.center);
    held.joint.follow(axis.dot(way) - held.joint.place);
    return;
  }
  const Vec3 start = directed(held.b, held.across_b);
  const SineCosine turn = sine_cosine(held.joint.place);
  const Vec3 expected = turn.cosine * start + turn.sine * axis.cross(start);
  held.joint.follow(axis.dot(expected.cross(directed(held.a, held.across_a))));
}

void BodyWorld::begin_held(Held& held) {
  if (!moves(held.a) && !moves(held.b)) return;
  follow(held);
  const Vec3 axis = directed(held.b, held.axis);
  const Vec3 spin = moves(held.b) ? bodies_[at(held.b)].spin() : Vec3(Vec3::Zero());
  held.joint.along = (axis + 0.5 * T_ * spin.cross(axis)).normalized();
  const Vec3 center = bodies_[at(held.a)].center();
  held.end_a = end_at(held.a, center);
  held.end_b = end_at(held.b, center);
  JointSide a, b;
  if (moves(held.a)) a.answer = bodies_[at(held.a)].answer();
  if (moves(held.b)) b.answer = bodies_[at(held.b)].answer();
  a.lever = held.end_a.lever;
  b.lever = held.end_b.lever;
  std::array<JointHold, 3> holds;
  for (std::size_t i = 0; i < held.links; ++i) {
    const Link& link = links_[held.first + i];
    a.links[i] = link.end_a.lever;
    b.links[i] = link.end_b.lever;
    holds[i] = {link.K * T_ / 2 + link.B, link.held};
  }
  held.joint.start(joint_answer(held.joint.turns(), a, b, {holds.data(), held.links}));
  push(held, held.joint.force());
}

// Velocity of a relative to b: of the joint's point, or angular.
Vec3 BodyWorld::speed(const Held& held) const {
  if (!held.joint.turns()) return velocity(held.end_a) - velocity(held.end_b);
  const auto turning = [&](int body) {
    return moves(body) ? bodies_[at(body)].turning() : Vec3(Vec3::Zero());
  };
  return turning(held.a) - turning(held.b);
}

void BodyWorld::push(const Held& held, const Vec3& force) {
  if (!held.joint.turns()) {
    apply(held.end_a, held.end_b, force);
    return;
  }
  const auto twist = [&](int body, const Vec3& torque) {
    if (!moves(body)) return;
    bodies_[at(body)].twist(torque);
    pushed_[at(body)] = 1;
  };
  if (force.isZero(0)) return;
  twist(held.a, force);
  twist(held.b, -force);
}

double BodyWorld::sweep(Link& link) {
  const Vec3 v = velocity(link.end_a) - velocity(link.end_b);
  Vec3 f;
  if (link.spring) {
    const double k = link.K * T_ / 2 + link.B, before = link.along.dot(link.force);
    const double v0 = link.along.dot(v) - link.c * before;
    f = -(link.K * (link.stretch.norm() - link.length) + k * v0) / (1 + k * link.c) * link.along;
  } else {
    const double k = link.K * T_ / 2 + link.B;
    f = -link.give * (link.K / k * link.stretch + v - link.W * link.force);
  }
  const Vec3 change = f - link.force;
  link.force = f;
  apply(link.end_a, link.end_b, change);
  return change.norm();
}

double BodyWorld::sweep(JointRow& row) {
  BodyMotion& body = bodies_[at(row.body)];
  AlongJoint along{body.joint(), body.joint_speed(), body.joint_answer()};
  const double change = sweep_joint(body.of_joint(), body.potential(), T_, along, row.forces);
  body.set_joint_speed(along.speed);
  pushed_[at(row.body)] |= row.forces.stop != 0 || row.forces.friction != 0;
  return change;
}

double BodyWorld::sweep(Held& held) {
  const Vec3 before = held.joint.force();
  const double change = held.joint.sweep(T_, speed(held));
  push(held, held.joint.force() - before);
  return change;
}

}  // namespace limpid
