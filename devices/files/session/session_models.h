// The models of a scene inside a session file: /models/0, /models/1, ... as bytes, each with the
// name that the scene's text has for it as the attribute "name".
#pragma once

#include <filesystem>

#include "devices/files/scene_files.h"
#include "devices/files/session/hdf5_reading.h"

namespace limpid {

// Before the first row. Errors: FileError.
void write_models(hid_t root, const SceneFiles& models, const std::filesystem::path& file);

// None in a session that has none. Errors: FileError for what is no such dataset or claims more
// than a file of this size can hold.
SceneFiles read_models(hid_t root, const std::filesystem::path& file, hdf5::Claims& claims);

}  // namespace limpid
