// All kinds of constraints among bodies, in one list.
#pragma once

#include <concepts>
#include <tuple>
#include <vector>

#include "core/touch/body_pair.h"
#include "core/touch/joint_between.h"
#include "core/touch/joint_link.h"
#include "core/touch/pull_link.h"
#include "core/touch/spring_link.h"
#include "core/touch/world_joint.h"

namespace limpid {

// Verbs of every kind, in the order of a tick. Each constraint is a force of three numbers between
// bodies a and b, one of which may be none.
template <class C>
concept BodyConstraint = requires(C& c, const C& known, Bodies& bodies, const Vec3& more) {
  requires std::convertible_to<decltype(known.a), int> &&
      std::convertible_to<decltype(known.b), int>;
  { C::kWakes } -> std::convertible_to<bool>;       // one side does not sleep while the other moves
  { known.off() } -> std::same_as<bool>;            // broken: takes part in nothing
  c.prepare(bodies);                                // starts from the last tick's force
  { c.solve(bodies) } -> std::same_as<double>;      // for the present velocities; the change [N]
  { known.forces() } -> std::convertible_to<Vec3>;  // the three numbers
  c.add(bodies, more);                              // adds to them
  // After the sweeps: energy that its force gives over the tick beyond what it takes from what is
  // stored [J]. If it is the right force, none.
  { known.made(bodies) } -> std::same_as<double>;
  c.hold(bodies);  // begins anew, for bodies that stand still
  c.finish(bodies);
};
// Kinds that last have energy, and numbers that are kept from tick to tick.
template <class C>
concept LastingConstraint = BodyConstraint<C> &&
    requires(C& c, const C& known, Bodies& bodies, const double* from) {
  { known.energy(bodies) } -> std::same_as<double>;  // stored at the tick's start [J]
  known.numbers();                                   // what is kept from tick to tick, an array
  c.read(from);                                      // zeros: as the scene has it
};

// A new kind has a line here and a place in the orders below. Sums are taken in these orders, so
// they decide on the last bits of rows; files have the third one.
struct BodyConstraints {
  std::vector<BodyPair> pairs;
  std::vector<JointLink> joint_links;
  std::vector<SpringLink> springs;
  std::vector<WorldJoint> world_joints;
  std::vector<JointBetween> joints_between;
  std::vector<PullLink> pulls;

  auto all() { return std::tie(pairs, joint_links, springs, world_joints, joints_between, pulls); }
  // Contacts come last: what presses then is right at the end of a sweep.
  auto in_sweeps() {
    return std::tie(world_joints, joints_between, joint_links, springs, pulls, pairs);
  }
  auto in_files() const { return std::tie(world_joints, joint_links, springs, joints_between); }
  auto in_files() { return std::tie(world_joints, joint_links, springs, joints_between); }
  // The order of all() without what comes and goes.
  auto lasting() const { return std::tie(joint_links, springs, world_joints, joints_between); }

  static_assert(BodyConstraint<BodyPair> && BodyConstraint<PullLink> &&
                LastingConstraint<JointLink> && LastingConstraint<SpringLink> &&
                LastingConstraint<WorldJoint> && LastingConstraint<JointBetween>);
};

// Calls visit(constraint) for each one of these kinds.
template <class Kinds, class Visit>
void for_each_of(const Kinds& kinds, const Visit& visit) {
  const auto visit_all = [&](auto& kind) {
    for (auto& constraint : kind) visit(constraint);
  };
  std::apply([&](auto&... kind) { (visit_all(kind), ...); }, kinds);
}

}  // namespace limpid
