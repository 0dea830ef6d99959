// Forces in a joint that links hold: damping and friction in a ball joint; all forces in a hinge or
// a slider between bodies.
#pragma once

#include <array>
#include <span>

#include "core/touch/held_joint.h"
#include "core/touch/joint_link.h"

namespace limpid {

struct JointBetween {
  // `links`: those that hold it; they stay where they are.
  JointBetween(const Bodies& bodies, int body, int to, std::span<JointLink> links);

  HeldJoint joint;
  int a, b;
  std::span<JointLink> links;
  // At the start: the axis, a direction across it and the centre of mass of a, in the frame of b;
  // and that direction in the frame of a.
  Vec3 axis, across_b, center, across_a;
  BodyEnd end_a, end_b;  // ends of a force along it, in the tick
  JointAnswer answer;    // in the tick

  static constexpr bool kWakes = false;  // its links do
  bool off() const { return false; }
  void prepare(Bodies& bodies);
  void turn(Bodies& bodies);  // after its links
  double solve(Bodies& bodies);
  Vec3 forces() const { return joint.numbers(); }
  double made(const Bodies& bodies) const { return joint.made(bodies.T, speed(bodies)); }
  void add(Bodies& bodies, const Vec3& more) {
    if (!more.isZero(0)) push(bodies, joint.add(more));
  }
  void hold(const Bodies&) { joint.hold(); }
  void finish(Bodies& bodies);
  double energy(const Bodies&) const { return joint.stored(); }
  // Sets the joint's place to that of its sides, from which a tick's own rotation leads it away.
  void follow(const Bodies& bodies);

  std::array<double, HeldJoint::kNumbers> numbers() const { return joint.kept(); }
  void read(const double* from) { joint.read(from); }

 private:
  void meet(const Bodies& bodies, const Vec3& at);  // the joint's stops, by its point on a
  void find_answer(const Bodies& bodies);
  Vec3 trembling(const Bodies& bodies) const;
  Vec3 speed(const Bodies& bodies) const;  // of a relative to b: of the joint's point, or angular
  void push(Bodies& bodies, const Vec3& force) const;
  double add_to_links(Bodies& bodies, const JointAnswer::Numbers& more);  // the largest change [N]
};

}  // namespace limpid
