// Which settings changed in a session, and when.
#pragma once

#include <filesystem>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"

namespace limpid {

// Fills the session's changes; its rows are read already. Errors: FileError.
void read_changes(hid_t group, Session& session, const std::filesystem::path& file,
                  hdf5::Claims& claims);

}  // namespace limpid
