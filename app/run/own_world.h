// Where an arm is tried that the built-in world was not made for.
#pragma once

#include <filesystem>

#include "core/dynamics/arm_description.h"
#include "devices/files/session/hand_file.h"
#include "devices/simulated/rig.h"

namespace limpid {

// Of the built-in arm's size, and standing as it does: the default scene and path are within its
// reach.
bool suits_default_world(const ArmDescription& arm);

// The scene that an arm is shown in at first: the default one where it suits, or nothing to touch.
std::filesystem::path default_scene(const ArmDescription& arm);

// The same of a device in the arm's place: one of two joints has a world of its own.
std::filesystem::path scene_of_device(const ArmDescription& arm);

// A small loop of the tip, a twentieth of the arm's reach to every side and slow, through what the
// joints can do: within the reach and within the limits.
struct SmallPath {
  HandPath hand;
  RigStart start;  // at rest at its beginning
};
SmallPath small_path(const ArmDescription& arm);

}  // namespace limpid
