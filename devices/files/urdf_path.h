// Path of an arm in a URDF: the joints from its root to its tip.
#pragma once

#include <urdf_model/model.h>

#include <string>
#include <vector>

#include "devices/files/urdf_values.h"

namespace limpid {

// Position of a joint that is held still: zero, or the limit next to it [rad or m].
double held_at(const urdf::Joint& joint);

// Returns whether a joint has a coordinate of its own: it is not fixed, mimics none, and its limits
// leave room.
bool moves(const urdf::Joint& joint);

// The joints from the root to `tip`; without a name, to the tip with the most moving joints.
// Grippers are no tips: where there is a choice, branches of slides, of joints that mimic others,
// and of joints that move no mass are passed by. Of several links at the end that are fixed to each
// other, the farthest one is taken. Errors: TipsToChoose; FileError for what is no tree, and for a
// tip that does not exist or does not move.
std::vector<urdf::JointConstSharedPtr> way_to_tip(const urdf::ModelInterface& model,
                                                  const std::string& tip, const UrdfPlaces& places);

}  // namespace limpid
