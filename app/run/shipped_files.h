// Files that came along with the program, found by their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

// Folders of assets in which a name without a folder may be.
using Kinds = std::vector<const char*>;

// Returns the names of a kind's files, sorted: arms of "devices", scenes, hands, sessions, stories,
// sweeps.
std::vector<std::string> shipped_names(const char* kind);
// Finds the file of that name; nothing if the name has a folder, or no such file came along.
std::optional<std::filesystem::path> shipped_file(const std::string& named, const Kinds& kinds);
// Returns "; did you mean table.toml?" if a file has nearly that name; else empty.
std::string shipped_hint(const std::string& named, const Kinds& kinds);

}  // namespace limpid
