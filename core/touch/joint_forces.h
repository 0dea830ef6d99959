// What acts along a joint of a body, or about it, over a tick: springs, detents, stops, friction.
#pragma once

#include "core/touch/body.h"
#include "core/touch/joint_potential.h"

namespace limpid {

// The part of critical damping that lets what is hit go with this part of its speed; of none, what
// lets it come to rest soonest [-].
double damping_ratio(double restitution);

// Along the joint, over the last tick [N] or [N m]. They are kept from tick to tick.
struct JointForces {
  double potential = 0, stop = 0, friction = 0;
  double anchor = 0;  // stretch of friction's spring [m] or [rad]

  double sum() const { return potential + stop + friction; }
};

// How what is on a joint moves along it, over a tick.
struct AlongJoint {
  double place = 0;   // at the start [m] or [rad]
  double speed = 0;   // mean, with all forces [m/s] or [rad/s]
  double answer = 0;  // what a force adds to that [m/(N s)] or [rad/(N m s)]
};

// Each force anew, as the others let it move: changes the forces, and the speed with them. Returns
// by how much they changed, all together. T [s].
double sweep_joint(const BodyJoint& joint, const JointPotential& potential, double T,
                   AlongJoint& along, JointForces& forces);

// What a joint stores: its potential, pressed stops and friction's stretch [J].
double stored(const BodyJoint& joint, const JointPotential& potential, double place, double anchor);

// The torque l = ball[-K (z + T (b + W l))] of a ball joint that rubs [N m], ball the projection on
// the ball of this radius [N m]: z the stretch of its spring [rad], b the angular velocity without
// l [rad/s], W what a torque adds to it [rad/(N m s)]. With z' = -l/K the work of l over the tick
// and the change of K |z|^2/2 are together not positive.
Vec3 friction_torque(double K, double radius, const Vec3& z, double T, const Vec3& b,
                     const Mat3& W);

}  // namespace limpid
