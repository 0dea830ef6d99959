// A wall before an arm's tip, as the loop samples it, in the hand: whether it is stable. The arm is
// near a pose, encoders are exact, and motors meet no limit.
#pragma once

#include <functional>

#include "core/coupling/spring_damper.h"
#include "core/math/sizes.h"

namespace limpid {

// Device and hand near a pose, at the joints (n x n).
struct HeldArm {
  Eigen::MatrixXd inertia;    // of the device with the hand's [kg m^2]
  Eigen::MatrixXd damping;    // of both [N m s/rad]
  Eigen::MatrixXd stiffness;  // of the hand [N m/rad]
  double T = 0.001;           // [s]
  int delay = 0;              // of the device's torque [ticks]
  Eigen::VectorXd weights;    // of the gains at each joint, see gain_weights() [-]
};

// Largest growth in a tick with a wall on the device itself, whose torque is held for a tick. wall:
// its stiffness at the joints (n x n) [N m/rad].
double growth_on_device(const HeldArm& arm, const Eigen::MatrixXd& wall);
// The same with the wall before a proxy of inertia M2 (n x n) [kg m^2] behind spring and damper,
// (1)-(2).
double growth_behind_spring(const HeldArm& arm, const SpringDamper& gains,
                            const Eigen::MatrixXd& M2, const Eigen::MatrixXd& wall);

// Feedforward of (14)-(15): of the contact's torque, and of the hand's as the observer (16)-(18)
// has it from raw velocities.
struct FedForward {
  double eta = 1, alpha = 0;  // [-], [N m s/rad]
  double phi = 0;             // (M1 + M2)^-1 M2, where M2 is a part of M1 [-]
  Eigen::MatrixXd inertia;    // M1, and damping b_d, as the observer believes them
  Eigen::VectorXd damping;
};
// The same with feedforward.
double growth_fed_forward(const HeldArm& arm, const SpringDamper& gains, const FedForward& forward,
                          const Eigen::MatrixXd& M2, const Eigen::MatrixXd& wall);

// Stiffest walls that were reckoned, and growth that round-off makes.
inline constexpr double kStiffestReckoned = 1e6;  // [N/m]
inline constexpr double kStillStable = 1 + 1e-9;

// Stiffness up to which all walls are stable [N/m]; infinite if all are up to kStiffestReckoned, 0
// if none is. growth: of a wall.
double stable_up_to(const std::function<double(double)>& growth);

}  // namespace limpid
