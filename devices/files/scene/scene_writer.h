// Scenes written to files, with the models that they name.
#pragma once

#include <filesystem>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// The files that an OBJ model refers to: materials, and the pictures that these name. Returns those
// that exist, each once, relative to the model's folder, without any outside of that folder (also
// through symbolic links). Errors: FileError for a model or materials that cannot be read.
std::vector<std::filesystem::path> obj_companions(const std::filesystem::path& obj);

// Writes the scene to `file` at one stroke, and returns it as that file has it. Models in the
// file's folder are named relative to it. Others are copied beside it, under another name if a
// different file has theirs. An .obj with materials or pictures is copied with these into a folder
// of their own. A .gltf or .dae, which may also consist of several files, is named where it is.
// Errors: FileError; `file` is then as it was.
SceneDocument save_scene(const SceneDocument& document, const ArmDescription& arm,
                         const std::filesystem::path& file);

}  // namespace limpid
