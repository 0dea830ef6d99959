// Files and folders that are named by the time at which they begin.
#pragma once

#include <filesystem>
#include <string_view>

namespace limpid {

// Returns a path of nothing that exists: "folder/name-20261130-173000.extension"; within the same
// second the next one ends with "-2". Without an extension it is for a folder.
std::filesystem::path dated_file(const std::filesystem::path& folder, std::string_view name,
                                 std::string_view extension = {});

}  // namespace limpid
