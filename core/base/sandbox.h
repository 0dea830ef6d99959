// The sandbox of processes that read strangers' files: it takes away for ever all rights that
// reading does not need.
#pragma once

#include <filesystem>

#include "core/base/sanitized.h"

namespace limpid {

// Restricts this process from now on. It opens files for reading only; where the kernel has
// Landlock, only `place` and all below it (nothing, if empty). It starts no program and no thread,
// sends nothing anywhere, and writes only to its descriptors 0 to 3; all others are closed. A
// sanitized program stays unrestricted. Errors: std::runtime_error if the kernel refuses.
void enter_sandbox(const std::filesystem::path& place);

}  // namespace limpid
