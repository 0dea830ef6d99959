// Which of a URDF's joints are the arm: the way from its root to its tip.
#pragma once

#include <urdf_model/model.h>

#include <string>
#include <vector>

#include "devices/files/urdf_values.h"

namespace limpid {

// Where a joint that is not moved stands: at zero, or at the limit next to it [rad or m].
double held_at(const urdf::Joint& joint);

// Whether a joint has a coordinate of its own: it is no fixed one, mimics none, and its limits
// leave it room.
bool moves(const urdf::Joint& joint);

// The joints from the root to `tip`. Without a name, to the tip with the most joints that move.
// Grippers are no tips: where there is a choice, branches of slides and of joints that mimic others
// are passed by, as is what moves without a mass. Of several links at the end that are fixed to
// each other the one farthest out. Errors: TipsToChoose; FileError for what is no tree, a tip that
// is not there or does not move.
std::vector<urdf::JointConstSharedPtr> way_to_tip(const urdf::ModelInterface& model,
                                                  const std::string& tip, const UrdfPlaces& places);

}  // namespace limpid
