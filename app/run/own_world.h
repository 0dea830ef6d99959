// Worlds and paths for arms that the built-in world was not made for.
#pragma once

#include <filesystem>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/hand_file.h"
#include "devices/simulated/rig.h"

namespace limpid {

// Returns whether the arm is as large as the built-in one and stands as it does: then the default
// scene and path are within its reach.
bool suits_default_world(const ArmDescription& arm);

// Returns the scene that an arm is shown in at first: the default one where it suits, or one with
// nothing to touch.
std::filesystem::path default_scene(const ArmDescription& arm);

// Returns the same for a device in the arm's place: one of two joints has a world of its own.
std::filesystem::path scene_of_device(const ArmDescription& arm);

// A small, slow loop of the tip, a twentieth of the arm's reach to every side, within the reach and
// the joints' limits.
struct SmallPath {
  HandPath hand;
  RigStart start;  // at rest at the path's beginning
};
SmallPath small_path(const ArmDescription& arm);

}  // namespace limpid
