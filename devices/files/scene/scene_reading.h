// What tables of a scene's file have in common.
#pragma once

#include <filesystem>
#include <string>

#include "core/touch/scene.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// A pose at a position, turned as `key` says, if it says something.
Pose pose_of(const TomlTable& t, const Vec3& position, const char* key);
Vec3 point_of(const TomlTable& t, const char* key);
std::string name_of(const TomlTable& t);

// Where `needed`, a table has to have the keys that every material needs.
Material material_of(const TomlTable& t, bool needed);

// The key `file`, of a kind that is read.
std::string model_of(const TomlTable& t);
// Of a file that exists.
std::filesystem::path model_path(const TomlTable& t, const std::string& file,
                                 const std::filesystem::path& base_dir);
// Model, scale and axes of a mesh.
void read_model_keys(const TomlTable& t, Mesh& mesh);
// Takes the model of a mesh into the document, if it is not there: from `files`, else the folder.
void take_model(const TomlTable& t, const Mesh& mesh, const std::filesystem::path& base_dir,
                const SceneFiles& files, SceneDocument& out);

}  // namespace limpid
