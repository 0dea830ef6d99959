// Rehearsal of a coupling on a device unlike its file: a simulated one, whose truth is known, is
// pressed against a stop and moved freely, in a simulated hand.
#pragma once

#include "core/tick/parameters.h"
#include "devices/identify/unlike_device.h"

namespace limpid {

struct Rehearsal {
  double slope = 0;  // of the coordination error against the contact torque [rad/(N m)]
  double off = 0;  // the hand's torque in free motion off the promised one, over that one, rms [-]
  double friction = 0;  // felt in free motion: torque against it, mean over the joints [N m]
  double weight = 0;    // felt in the middle of free motion: rms of the joints [N m]
  double energy = 0;    // largest E_c without the energy for the device's own forces [J]
  bool force = true;    // the loop ran all along; else its limits ended it
};

// Runs the device `truth` on its `bench` in a loop that takes it for `believed`. All is measured by
// its true motion, and by the torques that acted when they acted. Promised is eta times the
// device's inertia, and the damping b_d + b_v that the law leaves felt. Friction and weight are
// those that explain the hand's torque best, beside inertia, damping and a spring.
Rehearsal rehearse(const ArmDescription& truth, const Unlikeness& bench,
                   const ArmDescription& believed, const Parameters& p);

}  // namespace limpid
