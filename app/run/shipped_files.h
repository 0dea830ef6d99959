// Files that came along with the program, found by their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace limpid {

// Folders of assets: what a person may mean by a name without a folder.
using Kinds = std::vector<const char*>;

// Names of a kind's files, sorted: arms of "devices", scenes, hands, sessions, stories, sweeps.
std::vector<std::string> shipped_names(const char* kind);
// The one of that name; none where the name has a folder, or no such file came along.
std::optional<std::filesystem::path> shipped_file(const std::string& named, const Kinds& kinds);
// "; did you mean table.toml?", where the name is nearly that of one; else empty.
std::string shipped_hint(const std::string& named, const Kinds& kinds);

}  // namespace limpid
