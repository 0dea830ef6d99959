// Settings as the loop takes them while a real device has the arm's place. Tick, recordings and
// verdicts ask here, so that they agree.
#pragma once

#include <algorithm>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

struct RealDevice {
  double damping = 0;       // of the least damped joint, as the arm's file has it [N m s/rad]
  double torque = 0;        // the limit of the strongest joint [N m]
  double encoder_step = 0;  // as it says itself; 0: it does not [rad]

  static RealDevice of(const ArmDescription& arm, double encoder_step) {
    const auto less = [](const Joint& a, const Joint& b) { return a.damping < b.damping; };
    const auto weaker = [](const Joint& a, const Joint& b) { return a.effort < b.effort; };
    return {std::ranges::min_element(arm.joints, less)->damping,
            std::ranges::max_element(arm.joints, weaker)->effort, encoder_step};
  }
};

// A real device has the friction, the delay and the encoders that it has. What is set to try the
// virtual arm with gives it no more torque than its own limit, nor more damping than its file has:
// an observer would take that for a hand's force, and a law would feed it forward. A joint's torque
// is held to its own limit besides.
inline Parameters as_taken(Parameters p, const RealDevice& device) noexcept {
  if (!(p.damping < device.damping)) p.damping = kFromArm;
  if (!(p.torque_limit < device.torque)) p.torque_limit = kFromArm;
  p.friction = kFromArm;
  p.device_delay = 0;
  p.encoder_step = std::max(p.encoder_step, device.encoder_step);
  return p;
}

}  // namespace limpid
