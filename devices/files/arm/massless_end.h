// Chains that end in links without any mass.
#pragma once

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"

namespace limpid {

// Nothing holds back a joint beyond which nothing has mass: no torque could. Such joints at the end
// of the chain are held still, at 0 or the limit next to it, with a warning, and what they moved is
// fixed to the last link that has mass; the tip stays the tip. The first joint is left.
void shorten_to_mass(ArmDescription& arm, UrdfPlaces& places);

}  // namespace limpid
