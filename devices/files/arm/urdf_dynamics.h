// The part of a URDF that moves an arm.
#pragma once

#include <string>

#include "devices/files/arm/urdf_places.h"

class TiXmlElement;

namespace limpid {

// Links with their inertia and joints, as a URDF of its own: whatever else there is cannot trouble
// its reader. What the format asks for and real files leave out is filled in: limits of nothing but
// zeros are none, and slides without limits are held still, with a warning.
std::string urdf_dynamics(const TiXmlElement& robot, UrdfPlaces& places);

}  // namespace limpid
