#include "core/touch/joint_link.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/touch/joint_forces.h"

namespace limpid {
namespace {

// Distance between the points that make a hinge or a slider between bodies [m].
constexpr double kJointArm = 0.01;
// A link is this many times as stiff as its body's contacts, and little damped: a damper works
// against every stretch, and takes the energy of what swings.
constexpr double kStiffer = 100, kRatio = 0.7;
constexpr double kRight = 0.01;  // velocity that a right force may leave, of that of stretching [-]
constexpr double kMostLost = 1e-5;  // energy of the damper that is kept to pay for the stretch [J]

double damping(double K, double T, double directions, const Mat3& W) {
  const double m_eff = directions * BodyMotion::kTheta * T / W.trace();
  return 2 * kRatio * std::sqrt(K * m_eff);
}

}  // namespace

void add_links(const Bodies& bodies, int body, int to, std::vector<JointLink>& links) {
  const BodyJoint& joint = *bodies.about[Bodies::at(body)].joint;
  const Pose& pose = bodies[body].pose();
  const auto add = [&](const Vec3& point, bool rail) {
    JointLink link;
    link.a = body;
    link.b = to;
    link.on_a = point;
    const Vec3 there = pose * point;
    link.on_b = to == BodyContact::kStill ? there : bodies[to].pose().inverse() * there;
    link.point.K = kStiffer * bodies.about[Bodies::at(body)].contact_stiffness;
    if (rail) link.rail_axis = bodies[to].pose().linear().transpose() * joint.axis;
    links.push_back(link);
  };
  const Vec3 axis = pose.linear().transpose() * joint.axis;
  if (joint.kind == BodyJoint::Kind::ball) {
    add(joint.point, false);
  } else if (joint.kind == BodyJoint::Kind::hinge) {
    add(joint.point + kJointArm * axis, false);
    add(joint.point - kJointArm * axis, false);
  } else {
    const Vec3 across = pose.linear().transpose() * joint.axis.unitOrthogonal();
    for (const Vec3& arm : {axis, Vec3(-axis), across}) {
      add(pose.inverse() * bodies[body].center() + kJointArm * arm, true);
    }
  }
}

void JointLink::prepare(Bodies& bodies) {
  if (rail_axis) return prepare_rail(bodies);
  const Vec3 at_a = bodies.place(a, on_a), at_b = bodies.place(b, on_b);
  force.end_a = bodies.end_at(a, at_a);
  force.end_b = bodies.end_at(b, at_b);
  stretch(at_a - at_b);
  const Mat3 W = force.answer(bodies);
  point.B = damping(point.K, bodies.T, 3, W);
  point.yield(bodies.T, W);
  force.apply(bodies);
}

void JointLink::turn(Bodies& bodies) {
  if (rail_axis) return;
  force.turn(bodies, bodies.place(a, on_a), bodies.place(b, on_b));
  point.yield(bodies.T, force.answer(bodies));
}

// Holds the present place, by the point of the other body that is there now.
void JointLink::prepare_rail(Bodies& bodies) {
  const double T = bodies.T;
  const Vec3 at_a = bodies.place(a, on_a);
  force.end_a = bodies.end_at(a, at_a);
  force.end_b = bodies.end_at(b, at_a);
  const Vec3 now = bodies.directed(b, *rail_axis);
  const Vec3 off_rail = at_a - bodies.place(b, on_b);
  const Vec3 spin = bodies.spin(b);
  const auto later = [&](const Vec3& v) { return Vec3(v + 0.5 * T * spin.cross(v)); };
  const Vec3 axis = later(now).normalized();
  // The point on b is the one at a's place in the middle of the tick: otherwise the force and its
  // reaction would turn both.
  const auto speed = [&](int body) {
    if (!bodies.moves(body)) return Vec3(Vec3::Zero());
    const BodyMotion& motion = bodies[body];
    return Vec3(motion.speed() + motion.spin().cross(at_a - motion.center()));
  };
  force.end_b.lever += 0.5 * T * axis * axis.dot(speed(a) - speed(b));
  held = Mat3::Identity() - axis * axis.transpose();
  made_stretch = held * made_stretch;
  stretch(held * later(off_rail - now * now.dot(off_rail)));
  point.W = held * force.answer(bodies) * held;
  point.B = damping(point.K, T, 2, point.W);
  const double k = point.push(T);
  point.give = k * (Mat3::Identity() + k * point.W).inverse() * held;
  force.on_a = held * force.on_a;
  force.apply(bodies);
}

void JointLink::stretch(const Vec3& to) {
  const Vec3 way = to - made_stretch;
  // Part x of the way with K/2 (|s + x way|^2 - |s|^2) = lost.
  const double square = way.squaredNorm(), half = made_stretch.dot(way), most = 2 * lost / point.K;
  double part = 1;
  if (square + 2 * half > most) {
    const double root = std::sqrt(half * half + square * most);
    part = half > 0 ? most / (root + half) : (root - half) / square;
  }
  made_stretch += part * way;
  lost = std::max(0.0, lost - 0.5 * point.K * part * (2 * half + part * square));
  point.stretch = made_stretch;
}

void JointLink::finish(const Bodies& bodies) {
  const Vec3 v = held * force.speed(bodies);
  // A force that is not right may lose what another one makes: that pays for nothing.
  const bool right = left(bodies).norm() < kRight * v.norm();
  const double damped = right ? std::min(-made(bodies), bodies.T * point.B * v.squaredNorm()) : 0;
  lost = std::clamp(lost + damped, 0.0, kMostLost);
  made_stretch = point.stretch + bodies.T * v;
}

}  // namespace limpid
