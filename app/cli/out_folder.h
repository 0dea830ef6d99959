// A folder for what a command finds.
#pragma once

#include <filesystem>

namespace limpid {

// Before any work, so that none is lost on a place that cannot be written or is full: the folder is
// there then. Errors: UsageError.
void prepare_out(const std::filesystem::path& dir);

}  // namespace limpid
