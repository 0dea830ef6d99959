// What a URDF may leave out and an arm cannot do without: masses that only count as frames, efforts
// of 0.
#pragma once

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/urdf_places.h"

namespace limpid {

// Every link stores energy as soon as its joint moves, so that M is positive definite in every
// pose: a link without inertia of its own gets a thousandth of what hangs on it.
// Errors: FileError for an arm, or an end of it, without any, and for inertias of no body.
void complete_inertias(ArmDescription& arm, UrdfPlaces& places);

// An effort of 0 says nothing: it becomes twice what holds the arm stretched out level.
void complete_efforts(ArmDescription& arm, UrdfPlaces& places);

}  // namespace limpid
