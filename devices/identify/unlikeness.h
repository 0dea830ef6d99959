// How a device may be other than its file says: inertia, friction, gravity, springs, delay.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

struct Unlikeness {
  Vec3 gravity = Vec3::Zero();         // in the base's frame [m/s^2]
  double encoder_step = 0;             // [rad]
  int delay = 0;                       // [ticks]
  Eigen::VectorXd spring{}, offset{};  // of each joint; none: nothing [N m/rad, N m]
  double torque_scale = 1;             // what its motors give of what they are told
};

// The file's arm with other masses (half to twice), centres, damping and friction, drawn by this
// seed. `most_friction` [N m].
ArmDescription unlike(const ArmDescription& file, unsigned seed, double most_friction);

// Axes of 10 or 16 bits, a delay of 1 to 4 ms, springs, drawn by this seed; gravity as it is given.
Unlikeness drawn_bench(const ArmDescription& file, unsigned seed, const Vec3& gravity);
// Between 0.7 and 1.4, drawn by this seed.
double drawn_torque_scale(unsigned seed);

// The arm with a small thing of so many kg fixed to its tip.
ArmDescription loaded(ArmDescription arm, double mass);

}  // namespace limpid
