// From urdfdom's tree of links to the chain that the loop computes with.
#pragma once

#include <urdf_model/model.h>

#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"
#include "devices/files/arm/urdf_visuals.h"

namespace limpid {

// The joints of `way` that move, and everything else held still and merged into the links that they
// move. What is missing and can be guessed is, with a warning.
// Errors: FileError, as read_urdf.
ArmDescription chain_of(const urdf::ModelInterface& model,
                        const std::vector<urdf::JointConstSharedPtr>& way,
                        const LinkShapes& visuals, UrdfPlaces& places);

}  // namespace limpid
