// Arms that are described in full and yet cannot move.
#pragma once

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"

namespace limpid {

// Warns of joints whose friction holds against their own motor, of joints with hardly any range,
// and of a tip that no joint moves: what was found, and what to change.
void warn_of_immobile(const ArmDescription& arm, UrdfPlaces& places);

}  // namespace limpid
