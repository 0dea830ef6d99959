// A hand that leans a joystick into all sides of its gate, for the device and for the virtual arm.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "devices/simulated/rig.h"
#include "tests/support/hid/sprung_hand.h"
#include "tests/support/rows.h"

namespace limpid::test {

inline constexpr double kRange = 0.35;        // of the stick to each side [rad]
inline constexpr double kEffort = 0.5;        // of its motors [N m]
inline constexpr double kStickLength = 0.12;  // [m]

// The physics of the arm in assets/devices/joystick.urdf, axis by axis.
inline AxisPhysics stick_axis(int axis) {
  AxisPhysics physics;
  physics.inertia = axis == 0 ? 3.2e-4 : 3.0e-4;
  physics.friction = 0.015;
  physics.lower = -kRange;
  physics.upper = kRange;
  return physics;
}

// Rests for half a second, then leans the stick to the right, through the gate's side.
inline double lean_right(double t) { return 0.3 * std::clamp(2 * t - 1, 0.0, 1.0); }

struct Circling {
  static constexpr double kRest = 1.5;    // rest before the motion [s]
  static constexpr double kLean = 0.28;   // largest angle, behind the gate's sides [rad]
  static constexpr double kTurns = 0.37;  // turns a second
  static constexpr double kFastest = 2 * 3.14159265358979323846 * kTurns * kLean;  // [rad/s]

  // Path of an axis, t [s] -> [rad]: around and around, with the other axis slower.
  static double path(int axis, double t) {
    const double s = std::max(t - kRest, 0.0);
    const double grow = std::min(s, 1.0) * std::min(s, 1.0);
    return kLean * grow * std::sin(kFastest / kLean * (axis == 0 ? 1 : 0.61) * s);
  }
};

// Rows of the virtual arm under the same hand as joint torques, at these times of the hand [s].
inline Rows circle_virtually(const ArmDescription& arm, const Scene& scene,
                             const std::vector<double>& times) {
  const AxisPhysics hand = stick_axis(0);
  const Vec3 home(0, 0, kStickLength);
  Rig rig(arm, scene);
  RigStart state = rest_at(arm, home);
  rig.start({}, state);
  Rows rows(rig.layout());
  for (const double t : times) {
    rig.present(state);
    std::array<double, 2> torque{};
    for (std::size_t i = 0; i < 2; ++i) {
      const int axis = static_cast<int>(i);
      const double target = Circling::path(axis, t);
      const double speed = (Circling::path(axis, t + 1e-4) - target) / 1e-4;
      torque[i] =
          hand.stiffness * (target - state.x1[axis]) + hand.damping * (speed - state.v1[axis]);
    }
    rig.step({}, {{home, 0, torque}}, rows.add());
  }
  return rows;
}

struct Difference {
  double largest_torque = 0, worst = 0, rms = 0;  // [N m]
};

inline Difference difference(const Rows& device, const Rows& ideal) {
  Difference d;
  for (std::size_t k = 0; k < ideal.size(); ++k) {
    const Eigen::VectorXd torque = device.vec(k, Column::motor_torque);
    const Eigen::VectorXd error = torque - ideal.vec(k, Column::motor_torque);
    d.largest_torque = std::max(d.largest_torque, torque.cwiseAbs().maxCoeff());
    d.worst = std::max(d.worst, error.cwiseAbs().maxCoeff());
    d.rms += error.squaredNorm() / static_cast<double>(2 * ideal.size());
  }
  d.rms = std::sqrt(d.rms);
  return d;
}

// Bounds of the difference between the two [N m]. The virtual arm reads its angle and pushes at
// once. Here the newest reading is up to 1 ms old when a tick takes it, and the torque waits up to
// 1 ms for the I/O thread's next turn: it acts up to `delay` [s] later.
struct Allowed {
  double usual, touching;
};

// While the stick leans on the gate its torque changes with the hand's speed through three springs
// in a row: the hand's, the coupling's and the gate's (600 N/m at the tip). At the touch the stick
// has the hand's speed itself, or half more when it slips off, and only the latter two count. The
// device rounds angles to 65534 steps over its range and torques to so many over its effort.
inline Allowed allowed_difference(double delay, int torque_levels = 10000) {
  const double hand = stick_axis(0).stiffness, coupling = Parameters{}.k_vc;
  const double gate = 600 * kStickLength * kStickLength;
  const double rounding = coupling * 2 * kRange / 65534 + kEffort / torque_levels;
  return {delay * Circling::kFastest / (1 / hand + 1 / coupling + 1 / gate) + rounding,
          delay * 1.5 * Circling::kFastest / (1 / coupling + 1 / gate) + rounding};
}

}  // namespace limpid::test
