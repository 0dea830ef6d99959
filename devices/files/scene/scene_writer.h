// Scenes as TOML files, the way read_scene() reads them.
#pragma once

#include <filesystem>
#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// Text from which parse_scene() makes this scene again, to the last bit (rotations that no angles
// give exactly: to round-off). Meshes are named as the scene names them, visuals relative to
// `folder` where they lie inside of it. Comments of a text the scene came from are not in it.
std::string scene_text(const SceneDocument& document, const ArmDescription& arm,
                       const std::filesystem::path& folder = {});

// Writes the scene to `file` at one stroke, and returns it as that file has it. Models in the
// file's folder are named relative to it; others are copied beside it, under another name where a
// different file has theirs: an .obj that has materials or pictures with these, in a folder of
// their own. Of .gltf and .dae, which may also consist of several files, the scene names where they
// are. Errors: FileError; `file` is then as it was.
SceneDocument save_scene(const SceneDocument& document, const ArmDescription& arm,
                         const std::filesystem::path& file);

}  // namespace limpid
