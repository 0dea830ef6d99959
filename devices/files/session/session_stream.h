// Sessions that need not fit into memory: reading of rows in turn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "devices/files/session/session.h"

namespace limpid {

// Takes whole rows of a session in turn, and as many of its twin; empty if it has none.
using TakeRows = std::function<void(std::span<const double> rows, std::span<const double> twin)>;

// Reads a session in pieces: `begins` gets contents and changes, `take` the rows. Returns all but
// rows. A leftover may lack its last rows; changes at these are left out. Errors: as
// read_session(file).
Session read_session(const std::filesystem::path& file,
                     const std::function<void(const Session& about)>& begins, const TakeRows& take);

// Drops the changes at rows from `rows` on, where a leftover has fewer than it `claimed`.
void drop_lost(std::vector<SettingChange>& changes, std::uint64_t rows, std::uint64_t claimed);

// Puts rows into a session that was read without them.
void put_rows(Session& session, LargeVector<double> rows, LargeVector<double> twin);

}  // namespace limpid
