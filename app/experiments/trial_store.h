// Trials that were run before: taken again only from the very same program and plan.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "app/run/simulate.h"

namespace limpid {

// Beside NAME.h5 lies NAME.key: the trial's key and what the session file's bytes add up to.
// Written once the recording is closed. Errors: FileError.
void stamp(const std::filesystem::path& session, std::uint64_t key);
// The recording, if its stamp is there, says the same key, and not a byte has changed since.
std::optional<Session> stamped_session(const std::filesystem::path& file, std::uint64_t key);

}  // namespace limpid
