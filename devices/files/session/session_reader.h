// Reads session files, of this version and older ones.
#pragma once

#include <filesystem>

#include "devices/files/session/hdf5_reading.h"
#include "devices/files/session/session.h"
#include "devices/files/session/session_program.h"

namespace limpid {

// Which settings changed in a session, and when.

// Fills the session's changes; its rows are read already. Errors: FileError.
void read_changes(hid_t group, Session& session, const std::filesystem::path& file,
                  hdf5::Claims& claims);

// Reads HDF5 files in this process, as only limpid-session does: what a broken or hostile file does
// to HDF5's library ends that program. The others have read_session(), write_marks() and
// read_table(), which call it.
Session read_session_here(const std::filesystem::path& file);
// All texts and whole numbers at the root, and the columns /done and /measure/... Errors: FileError
// for files that have none.
wire::Table read_table_here(const std::filesystem::path& file);

// Times that do not increase, and laws that there are not. Errors: FileError.
void check_rows(const Session& session, const std::filesystem::path& file);

}  // namespace limpid
