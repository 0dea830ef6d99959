// Scenes in which the tip of the built-in arm moves bodies, and runs of them.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"
#include "core/tick/parameters.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"

namespace limpid::test {

struct BodyBench {
  std::string name;
  Scene scene{};
  double grip = 300;   // stiffness of the hand [N/m]
  double seconds = 2;  // length of the run
  double held = 2;     // time from which the hand stands still and nothing is to move [s]
  std::function<HandInput(double t)> hand{};
};

// Material and mass of the bodies in a scene.
struct BodyKind {
  double mass = 0.05;       // [kg]
  double stiffness = 2000;  // against the tip [N/m]
  double friction = 0.5;    // [-]
  double between = 20000;   // K_o, against other bodies [N/m]
};

inline Object cube(const std::string& name, const Vec3& size, const Vec3& at,
                   const BodyKind& kind) {
  Object o;
  o.name = name;
  o.shape = Box{size};
  o.pose = pose_at(at);
  o.material = {kind.stiffness, 0, kind.friction, kind.friction};
  o.body = Body{};
  o.body->mass = kind.mass;
  o.body->contact_stiffness = kind.between;
  return o;
}

inline Object still_box(const Vec3& size, const Vec3& at) {
  Object o;
  o.name = "wall";
  o.shape = Box{size};
  o.pose = pose_at(at);
  o.material.stiffness = 2000;
  return o;
}

inline Object floor_below(double z) {
  Object o;
  o.name = "floor";
  o.shape = Plane{};
  o.pose = pose_at({0, 0, z});
  o.material.stiffness = 2000;
  return o;
}

// Leads the hand along y from -1 cm, by `way` [m] within `seconds`, then holds it.
inline std::function<HandInput(double)> going_along(double way, double seconds, double z) {
  return
      [=](double t) { return HandInput{Vec3(0.18, -0.01 + way * std::min(t / seconds, 1.0), z)}; };
}

inline BodyBench free_push(const BodyKind& kind) {
  BodyBench b{.name = "free push", .hand = going_along(0.06, 1.5, 0)};
  b.scene.gravity.setZero();
  b.scene.add(cube("cube", Vec3::Constant(0.03), {0.18, 0.03, 0}, kind));
  return b;
}

inline BodyBench push_with_friction(const BodyKind& kind) {
  BodyBench b{.name = "push with friction", .held = 1.5, .hand = going_along(0.04, 1, -0.017)};
  b.scene.add(floor_below(-0.03));
  b.scene.add(cube("cube", Vec3::Constant(0.03), {0.18, 0.03, -0.015}, kind));
  return b;
}

inline BodyBench squeeze(const BodyKind& kind) {
  BodyBench b{.name = "squeeze", .seconds = 3, .held = 2.5, .hand = going_along(0.05, 1.5, 0)};
  b.scene.gravity.setZero();
  b.scene.add(still_box({0.1, 0.02, 0.1}, {0.18, 0.06, 0}));
  b.scene.add(cube("cube", Vec3::Constant(0.03), {0.18, 0.03, 0}, kind));
  return b;
}

inline BodyBench row_of_two(const BodyKind& kind) {
  BodyBench b{.name = "row of two", .seconds = 3, .held = 2.5, .hand = going_along(0.05, 1.5, 0)};
  b.scene.gravity.setZero();
  b.scene.add(still_box({0.1, 0.02, 0.1}, {0.18, 0.092, 0}));
  b.scene.add(cube("near", Vec3::Constant(0.03), {0.18, 0.03, 0}, kind));
  b.scene.add(cube("far", Vec3::Constant(0.03), {0.18, 0.063, 0}, kind));
  return b;
}

// A button whose spring pushes back all the way, or holds it down beyond half of its travel.
inline BodyBench button(BodyKind kind, bool stays_down) {
  BodyBench b{.name = stays_down ? "bistable button" : "button", .grip = 3000, .seconds = 3};
  b.scene.gravity.setZero();
  kind.mass = std::min(kind.mass, 0.002);
  Object o = cube("button", {0.012, 0.012, 0.006}, {0.18, 0, -0.01}, kind);
  BodyJoint& joint = o.body->joint.emplace();
  joint.axis = -Vec3::UnitZ();
  joint.low = 0;
  joint.high = 0.0096;
  joint.force.travel = {{0, 0.5}, {0.002, 0.9}, {0.006, stays_down ? -0.3 : 0.1}, {0.0096, 0.9}};
  b.scene.add(o);
  // The hand presses the button twice, then holds it down.
  b.hand = [](double t) {
    const double in = t < 2 ? 0.5 - 0.5 * std::cos(2 * M_PI * t)
                            : 0.5 - 0.5 * std::cos(M_PI * std::min(t - 2, 0.5) / 0.5);
    return HandInput{Vec3(0.18, 0, 0.002 - 0.012 * in)};
  };
  b.held = 2.8;
  return b;
}

inline BodyBench door(BodyKind kind) {
  BodyBench b{.name = "door", .seconds = 2.5, .held = 2, .hand = going_along(0.05, 1, 0)};
  b.scene.gravity.setZero();
  Object o = cube("door", {0.1, 0.006, 0.05}, {0.14, 0.01, 0}, kind);
  BodyJoint& joint = o.body->joint.emplace();
  joint.kind = BodyJoint::Kind::hinge;
  joint.point = {-0.05, 0, 0};
  joint.low = -1;
  joint.high = 0.25;
  b.scene.add(o);
  return b;
}

// A body that the magnet picks up, moves about, holds and lets go.
inline BodyBench magnet(const BodyKind& kind) {
  BodyBench b{.name = "magnet"};
  b.scene.gravity.setZero();
  Object o = cube("cube", Vec3::Constant(0.03), {0.18, 0.02, 0}, kind);
  o.body->magnet = true;
  b.scene.add(o);
  b.hand = [](double t) {
    HandInput hand{Vec3(0.18, 0.02 * std::sin(6 * t), 0)};
    hand.magnet = t < 1.5;
    return hand;
  };
  return b;
}

inline BodyBench drop(const BodyKind& kind) {
  BodyBench b{.name = "drop", .seconds = 0.5};
  b.scene.add(floor_below(-0.03));
  b.scene.add(cube("cube", Vec3::Constant(0.03), {0.18, 0, 0.119}, kind));
  b.hand = [](double) { return HandInput{Vec3(0.18, 0, 0)}; };
  return b;
}

// A lever on a hinge with twelve detents a turn; the magnet holds its end.
inline BodyBench knob(BodyKind kind) {
  BodyBench b{.name = "knob", .seconds = 3, .held = 2.6};
  b.scene.gravity.setZero();
  kind.mass = std::min(kind.mass, 0.02);
  Object o = cube("knob", {0.03, 0.01, 0.01}, {0.16, 0, 0}, kind);
  o.body->magnet = true;
  BodyJoint& joint = o.body->joint.emplace();
  joint.kind = BodyJoint::Kind::hinge;
  joint.point = {-0.015, 0, 0};
  joint.force.detent_force = 0.005;
  joint.force.detent_period = 2 * M_PI / 12;
  b.scene.add(o);
  b.hand = [](double t) {
    const double turned = 0.9 * std::min(t / 2, 1.0);
    HandInput hand{Vec3(0.145 + 0.036 * std::cos(turned), 0.036 * std::sin(turned), 0)};
    hand.magnet = true;
    return hand;
  };
  return b;
}

// The same bench with a ball for a tip.
inline BodyBench with_tip(BodyBench bench) {
  bench.scene.tip_radius = 0.004;
  return bench;
}

inline std::vector<BodyBench> body_benches(const BodyKind& kind) {
  std::vector<BodyBench> all{free_push(kind),     push_with_friction(kind),
                             squeeze(kind),       row_of_two(kind),
                             button(kind, false), button(kind, true),
                             door(kind),          magnet(kind),
                             drop(kind),          knob(kind)};
  for (BodyBench& bench : all) bench.scene.tip_radius = 0.004;
  return all;
}

struct BodyRun {
  double energy = 0;    // highest E_c [J]
  double beyond = 0;    // most energy that the hand was given beyond what bodies gave [J]
  double given = 0;     // likewise, beyond what bodies gave only where they gave any [J]
  double gain = 0;      // most energy that the bodies' world made [J]
  double reserve = 0;   // lowest ledger, less its initial value [J]
  double governor = 1;  // lowest
  double chatter = 0;   // rms speed of the tip above 20 Hz while the hand holds still [m/s]
  double moved = 0;     // furthest motion of a body [m]
  double hardest = 0;   // largest force on the tip [N]
  int stood_still = 0;  // ticks without a solution
  int limited = 0;      // ticks with a motor at its limit
  bool diverged = false;
  std::vector<Vec3> hand;  // mean force of the hand at the tip over each tick [N]
};

inline BodyRun run(const BodyBench& bench, Parameters p) {
  const ArmDescription arm = omni();
  p.hand_stiffness = bench.grip;
  Rig rig(arm, bench.scene);
  rig.start(p, rest_at(arm, bench.hand(0).target));
  const RowLayout& layout = rig.layout();
  std::vector<double> row(static_cast<std::size_t>(layout.stride())), first;
  const auto at = [&](Column c) { return layout.in(std::span<const double>(row), c); };
  BodyRun all;
  std::array<HighPass, 3> fast{HighPass(20, 1 / p.tick), HighPass(20, 1 / p.tick),
                               HighPass(20, 1 / p.tick)};
  const Arm<3> model(arm);
  Arm<3>::Frames frames;
  Jacobian<3> J;
  double fast2 = 0, reserve = 0;
  int held = 0;
  Vec3 before = rig.tip();
  for (int k = 0; k * p.tick < bench.seconds; ++k) {
    // The hand moves over the tick to its target at the tick's end.
    rig.step(p, {bench.hand((k + 1) * p.tick)}, row);
    if (k == 0) reserve = at(Column::energy_ledger)[0];
    const auto pose = at(Column::body_pose);
    if (k == 0) first.assign(pose.begin(), pose.end());
    all.energy = std::max(all.energy, at(Column::energy_total)[0]);
    all.beyond =
        std::max(all.beyond, at(Column::energy_port)[0] + at(Column::energy_to_objects)[0]);
    all.given = std::max(
        all.given, at(Column::energy_port)[0] + std::min(0.0, at(Column::energy_to_objects)[0]));
    all.gain = std::max(all.gain, at(Column::objects_gain)[0]);
    all.reserve = std::min(all.reserve, at(Column::energy_ledger)[0] - reserve);
    all.governor = std::min(all.governor, at(Column::governor)[0]);
    all.stood_still += at(Column::solved)[0] == 3;
    all.limited += at(Column::solved)[0] == 1;
    const auto force = at(Column::contact_force);
    all.hardest = std::max(all.hardest, Vec3(force[0], force[1], force[2]).norm());
    for (std::size_t i = 0; i < pose.size(); i += kPoseNumbers) {
      all.moved = std::max(all.moved, std::hypot(pose[i] - first[i], pose[i + 1] - first[i + 1],
                                                 pose[i + 2] - first[i + 2]));
    }
    const Vec3 tip = rig.tip();
    Vec3 v = (tip - before) / p.tick;
    before = tip;
    for (int i = 0; i < 3; ++i) v[i] = fast[static_cast<std::size_t>(i)](v[i]);
    if (k * p.tick >= bench.held) {
      fast2 += v.squaredNorm();
      ++held;
    }
    const auto torque = at(Column::hand_torque);
    const auto position = at(Column::device_position);
    model.frames(Vec3(position[0], position[1], position[2]), frames);
    model.point_jacobian(frames, 2, model.tip(frames), J);
    all.hand.emplace_back(Mat3(J.transpose()).inverse() * Vec3(torque[0], torque[1], torque[2]));
    all.diverged = rig.diverged() || !std::isfinite(tip.norm());
    if (all.diverged) break;
  }
  if (held > 0) all.chatter = std::sqrt(fast2 / held);
  return all;
}

}  // namespace limpid::test
