// Files that are named by the time at which they begin.
#pragma once

#include <filesystem>
#include <string_view>

namespace limpid {

// Returns "folder/name-20261130-173000.extension" with the present time; a second one within that
// second ends with "-2".
std::filesystem::path dated_file(const std::filesystem::path& folder, std::string_view name,
                                 std::string_view extension);

}  // namespace limpid
