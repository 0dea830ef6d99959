// Sessions written as tables.
#pragma once

#include <filesystem>

#include "devices/files/session/session.h"

namespace limpid {

inline constexpr const char* kStandardOutput = "-";  // as the name of a table

// Writes one row a tick and one column a number, as a session file of this version has them.
// Columns are named as the datasets, joints counted from 1, each with its unit: time_s,
// device_position_1_rad, ... device_tip_x_m, ...; those of further runs follow: twin_time_s,
// lane3_time_s,
// ... Every value reads back to the file's bits. Errors: FileError if OUT exists and not `force`,
// or cannot be written.
void write_csv(const Session& session, const std::filesystem::path& out, bool force);

}  // namespace limpid
