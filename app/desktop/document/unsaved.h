// Changes of a scene that nobody could be asked about, because Limpid was ended from outside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

// Writes the scene, known as `name`, to folder/NAME-unsaved.toml, or beside one of an earlier time.
// Returns the file. Errors: FileError and std::filesystem::filesystem_error.
std::filesystem::path keep_unsaved(const SceneDocument& document, const ArmDescription& arm,
                                   const std::string& name, const std::filesystem::path& folder);

// What was kept so, each once: from then on it is a scene like others, NAME-recovered.toml.
std::vector<std::filesystem::path> take_unsaved(const std::filesystem::path& folder);

}  // namespace limpid
