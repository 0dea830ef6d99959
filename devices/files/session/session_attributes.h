// What a session file says of itself and of its input, beside the rows.
#pragma once

#include <hdf5.h>

#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

// Writes the attributes of the `root` group. Errors: FileError naming `file`.
void write_attributes(hid_t root, const SessionInfo& info, const std::filesystem::path& file);

}  // namespace limpid
