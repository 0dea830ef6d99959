// Provenance of figures and tables: one line that says which program made them, of which settings.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "core/tick/parameters.h"
#include "devices/files/session/session.h"

namespace limpid {

// Returns eight hexadecimal digits, the same for equal settings. Several settings may come in any
// order.
std::string settings_digest(const Parameters& p);
std::string settings_digest(const std::set<std::string>& configs);

// Returns the day [UTC], as 2026-11-26: today, or that of SOURCE_DATE_EPOCH, for files that have to
// be the same again.
std::string today();

// Returns "limpid 0.2.0, settings 3f2a94d1, seed 1, 2026-11-26", without empty parts. `date`: empty
// for files that are the same however, and whenever, they are made.
std::string provenance(const std::string& settings, std::optional<std::uint64_t> seed,
                       const std::string& date = today());

// Returns the line of a recording: the version that made it, its settings, its seed, the day it was
// made.
std::string provenance_of(const SessionInfo& info);

// Puts the line into a <metadata> behind the root's first tag; leaves an SVG without such a tag as
// it is.
std::string with_metadata(const std::string& svg, const std::string& line);

}  // namespace limpid
