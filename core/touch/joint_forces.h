// Forces along a body's joint, or torques about it, over a tick: springs, detents, stops, friction.
#pragma once

#include "core/touch/body.h"
#include "core/touch/joint_potential.h"
#include "core/touch/stop_hit.h"

namespace limpid {

// Damping ratio of a stop by its restitution: the share of the speed that remains after a hit.
// Without restitution the ratio that comes to rest soonest [-].
double damping_ratio(double restitution);

// Forces along the joint over the last tick [N] or [N m], kept from tick to tick.
struct JointForces {
  double potential = 0, stop = 0, friction = 0;
  double anchor = 0;  // stretch of friction's spring [m] or [rad]
  StopHit hit;

  double sum() const { return potential + stop + friction; }
  // The speed of a hit, for the next tick; before the joint meets its stop it is found anew.
  double kept_hit() const { return hit.speed < 0 || stop != 0 ? hit.speed : 0; }
  // A hit that keeps its energy bears nothing.
  bool presses() const { return (stop != 0 && !hit.lossless) || friction != 0; }
};

// Motion along a joint over a tick.
struct AlongJoint {
  double place = 0;   // at the start [m] or [rad]
  double speed = 0;   // mean, with all forces [m/s] or [rad/s]
  double answer = 0;  // response of the speed to a force [m/(N s)] or [rad/(N m s)]
};

// Updates each force in turn by the motion under the others: changes the forces, and the speed with
// them. Returns the change of them all together. T [s].
double sweep_joint(const BodyJoint& joint, const JointPotential& potential, double T,
                   AlongJoint& along, JointForces& forces);

// Energy stored in a joint: potential, pressed stops and friction's stretch [J].
double stored(const BodyJoint& joint, const JointPotential& potential, double place, double anchor);

// Energy that the forces gave over a tick beyond what they took from what is stored [J].
double made(const BodyJoint& joint, const JointPotential& potential, double T,
            const AlongJoint& along, const JointForces& forces);

// Friction torque l of a ball joint, the projection of -K (z + T (b + W l)) on a ball of this
// radius [N m]. z: stretch of its spring [rad]; b: angular velocity without l [rad/s]; W: response
// to a torque [rad/(N m s)]. With z' = -l/K the work of l over the tick and the change of K |z|^2/2
// are together not positive.
Vec3 friction_torque(double K, double radius, const Vec3& z, double T, const Vec3& b,
                     const Mat3& W);

}  // namespace limpid
