// Sessions that need not fit into memory: reading of rows in turn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "devices/files/session/session.h"

namespace limpid {

// Takes whole rows of a session in turn.
using TakeRows = std::function<void(LaneRows rows)>;

// Reads a session in pieces: `begins` gets contents and changes, `take` the rows. Returns all but
// rows. A leftover may lack its last rows; changes at these are left out. Errors: as
// read_session(file).
Session read_session(const std::filesystem::path& file,
                     const std::function<void(const Session& about)>& begins, const TakeRows& take);

// Adds a lane without rows, which begins with the parameters `config` (TOML).
void add_lane(Session& session, std::string config);
// Drops the changes at rows from `rows` on, where a leftover has fewer than it `claimed`.
void drop_lost(Session& session, std::uint64_t rows, std::uint64_t claimed);

}  // namespace limpid
