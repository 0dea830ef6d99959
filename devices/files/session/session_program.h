// The program limpid-session, seen from the one that calls it.
#pragma once

#include "devices/files/session/session_wire.h"

namespace limpid {

inline constexpr const char* kSessionProgram = "limpid-session";

// The texts, whole numbers and columns of a sweep's table. Errors: FileError for what is no table,
// damaged, or crashes what reads it.
wire::Table read_table(const std::filesystem::path& file);

}  // namespace limpid
