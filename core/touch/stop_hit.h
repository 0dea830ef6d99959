// Restitution of a joint's stops: how fast what hits one leaves it again.
#pragma once

#include "core/touch/body.h"

namespace limpid {

// A hit on a joint's stop, from the tick in which the joint meets it until it is off it again, or
// is pressed onto it once more. The stop's spring slows the joint down as it does without a hit,
// but gives back no more speed than the restitution's part of the speed of the hit: it pushes less,
// and in the tick in which the joint turns it pulls where a tick's own bounce was faster. Both only
// take energy. So the restitution is what it says for any inertia, stiffness and tick.
struct StopHit {
  static constexpr double kLeastKept = 0.01;  // part of the speed that brings a joint off its stop
  // Speed of the hit, kept from tick to tick; negative once the joint has turned, zero: none [m/s]
  // or [rad/s].
  double speed = 0;
  // State of the tick. The least mean speed towards the stop that it lets the joint have.
  double least = 0;
  bool holds = false;     // the joint was on the stop at the start
  bool pulls = false;     // it had not turned yet
  bool lossless = false;  // the stop has no damper
  double trembling = 0;   // part of the mean speed that is the stretching of the joint's links

  // Begins a tick: the joint's place and its speed, theta of its bodies, the stop's force over the
  // last tick [N] or [N m], and the length T [s].
  void begin(const BodyJoint& joint, double place, double rate, double theta, double force,
             double T);
  // Ends a tick in which the joint went this way [m] or [rad].
  void finish(const BodyJoint& joint, double place, double way);
  // Returns what is left of the stop's force off it, for the mean speed towards the stop without it
  // and the response of that speed. `sign`: of a force off it, along the joint.
  double limited(double force, double free, double sign, double answer) const;
};

// True if the upper one of a joint's stops is the nearer one.
inline bool upper_is_nearer(const BodyJoint& joint, double place) {
  return place - joint.high > joint.low - place;
}

}  // namespace limpid
