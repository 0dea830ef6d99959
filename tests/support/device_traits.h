// Traits of devices that tests make up.
#pragma once

#include "devices/device.h"

namespace limpid::test {

// Traits of a device with a motor in every joint.
inline DeviceTraits pushing(int dof, double range = 1, double effort = 0.5) {
  const auto joints = static_cast<std::size_t>(dof);
  DeviceTraits traits;
  traits.name = "A device";
  traits.dof = dof;
  traits.pushes = true;
  traits.lower.assign(joints, -range);
  traits.upper.assign(joints, range);
  traits.resolution.assign(joints, 1e-4);
  traits.effort.assign(joints, effort);
  return traits;
}

}  // namespace limpid::test
