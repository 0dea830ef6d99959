// What a coupling is worth on a device that is not what its file says: a simulated one, whose truth
// is known, is pressed against a stop and moved freely, in a simulated hand.
#pragma once

#include "core/tick/parameters.h"
#include "devices/identify/unlike_device.h"

namespace limpid {

struct Rehearsal {
  double slope = 0;     // of the coordination error against the contact torque [rad/(N m)]
  double off = 0;       // the hand's torque in free motion off the one promised, of it, rms [-]
  double friction = 0;  // felt there: a torque against the motion, mean over the joints [N m]
  double weight = 0;    // felt there, in the middle of the motion: rms of the joints [N m]
  double energy = 0;    // most of E_c without what was for the device's own forces [J]
  bool force = true;    // the loop ran all along; else it was ended by its limits
};

// The device `truth` on its `bench`, driven by a loop that takes it for `believed`. All is measured
// by its true motion, and by the torques that acted when they acted. Promised is eta times the
// device's inertia, and the damping b_d + b_v that the law leaves felt; friction and weight are
// what explains the hand's torque best, beside inertia, damping and a spring.
Rehearsal rehearse(const ArmDescription& truth, const Unlikeness& bench,
                   const ArmDescription& believed, const Parameters& p);

}  // namespace limpid
