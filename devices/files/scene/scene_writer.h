// Scenes written to files, with the models that they name.
#pragma once

#include <filesystem>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// The files that an OBJ model refers to: its materials, and the pictures that these name.

// Those that are there, relative to the model's folder, each once. What lies outside of that
// folder, also through a symbolic link, is none of them. Errors: FileError for a model or materials
// that cannot be read.
std::vector<std::filesystem::path> obj_companions(const std::filesystem::path& obj);

// Writes the scene to `file` at one stroke, and returns it as that file has it. Models in the
// file's folder are named relative to it; others are copied beside it, under another name where a
// different file has theirs: an .obj that has materials or pictures with these, in a folder of
// their own. Of .gltf and .dae, which may also consist of several files, the scene names where they
// are. Errors: FileError; `file` is then as it was.
SceneDocument save_scene(const SceneDocument& document, const ArmDescription& arm,
                         const std::filesystem::path& file);

}  // namespace limpid
