// Differences between a device and its file: inertia, friction, gravity, springs, delay.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

struct Unlikeness {
  Vec3 gravity = Vec3::Zero();         // in the base's frame [m/s^2]
  double encoder_step = 0;             // [rad]
  int delay = 0;                       // [ticks]
  Eigen::VectorXd spring{}, offset{};  // of each joint [N m/rad, N m]; empty: none
  double torque_scale = 1;             // torque that the motors give over what they are told
};

// The file's arm with other masses (half to twice), centres, damping and friction, drawn by `seed`.
// `most_friction` [N m].
ArmDescription unlike(const ArmDescription& file, unsigned seed, double most_friction);

// Draws axes of 10 or 16 bits, a delay of 1 to 4 ms and springs by `seed`; gravity as given.
Unlikeness drawn_bench(const ArmDescription& file, unsigned seed, const Vec3& gravity);
// Draws a scale between 0.7 and 1.4 by `seed`.
double drawn_torque_scale(unsigned seed);

// The arm with a small load of `mass` [kg] fixed to its tip.
ArmDescription loaded(ArmDescription arm, double mass);

}  // namespace limpid
