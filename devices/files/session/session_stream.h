// Sessions that need not fit into memory: their rows in turn.
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "devices/files/session/session.h"

namespace limpid {

// Rows of a session in turn, whole ones, and as many of its twin's; empty: it has none.
using TakeRows = std::function<void(std::span<const double> rows, std::span<const double> twin)>;

// Reads a session in pieces: `begins` hears what it is of and what changes, `take` its rows.
// Returns all but rows. A leftover may lack its last rows; changes at them are not returned.
// Errors: as read_session(file).
Session read_session(const std::filesystem::path& file,
                     const std::function<void(const Session& about)>& begins, const TakeRows& take);

// Gives a session that was read so its rows.
void put_rows(Session& session, LargeVector<double> rows, LargeVector<double> twin);

}  // namespace limpid
