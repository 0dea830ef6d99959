// From urdfdom's tree of links to the chain that the loop computes with.
#pragma once

#include <urdf_model/model.h>

#include <map>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"

namespace limpid {

using LinkVisuals = std::map<std::string, std::vector<Visual>>;

// The joints of `way` that move, and everything else held still and merged into the links that they
// move. What is missing and can be guessed is, with a warning.
// Errors: FileError, as read_urdf.
ArmDescription chain_of(const urdf::ModelInterface& model,
                        const std::vector<urdf::JointConstSharedPtr>& way,
                        const LinkVisuals& visuals, UrdfPlaces& places);

}  // namespace limpid
