// Readers of what the tables of a scene's file have in common.
#pragma once

#include <filesystem>
#include <string>

#include "core/touch/scene.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// The pose at `position`, turned as `key` says, if it is there.
Pose pose_of(const TomlTable& t, const Vec3& position, const char* key);
Vec3 point_of(const TomlTable& t, const char* key);
std::string name_of(const TomlTable& t);

// Holds a colour, if there is one, within what a file may say.
void hold_color(std::optional<Vec3>& color);

// Reads the key `file`: a model of a kind that can be read.
std::string model_of(const TomlTable& t);
// The absolute path of a model. Errors: FileError if the file does not exist.
std::filesystem::path model_path(const TomlTable& t, const std::string& file,
                                 const std::filesystem::path& base_dir);
// Reads model, scale and axes of a mesh.
void read_model_keys(const TomlTable& t, Mesh& mesh);
// Takes a mesh's model into the document, unless it has it: from `files`, else from the folder.
void take_model(const TomlTable& t, const Mesh& mesh, const std::filesystem::path& base_dir,
                const SceneFiles& files, SceneDocument& out);

}  // namespace limpid
