// Parameters as the loop takes them for a real device instead of the virtual arm. Tick, recordings
// and verdicts use them, so that they agree.
#pragma once

#include <algorithm>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"

namespace limpid {

struct RealDevice {
  double damping = 0;       // of the least damped joint, by the arm's file [N m s/rad]
  double torque = 0;        // limit of the strongest joint [N m]
  double encoder_step = 0;  // as the device reports; 0: unknown [rad]

  static RealDevice of(const ArmDescription& arm, double encoder_step) {
    const auto less = [](const Joint& a, const Joint& b) { return a.damping < b.damping; };
    const auto weaker = [](const Joint& a, const Joint& b) { return a.effort < b.effort; };
    return {std::ranges::min_element(arm.joints, less)->damping,
            std::ranges::max_element(arm.joints, weaker)->effort, encoder_step};
  }
};

// Replaces settings meant for the virtual arm: a real device has its own friction, delay and
// encoders. Its torque limit and damping are at most those of its file: an observer would take more
// damping for a hand's force, and a law would feed it forward. Each joint's torque also stays
// within its own limit.
inline Parameters as_taken(Parameters p, const RealDevice& device) noexcept {
  if (!(p.damping < device.damping)) p.damping = kFromArm;
  if (!(p.torque_limit < device.torque)) p.torque_limit = kFromArm;
  p.friction = kFromArm;
  p.device_delay = 0;
  p.encoder_step = std::max(p.encoder_step, device.encoder_step);
  static_cast<PlantSettings&>(p) = {};
  return p;
}

}  // namespace limpid
