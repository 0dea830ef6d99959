// Folders that an environment variable lists.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

namespace limpid {

// As PATH: with colons between; none if it is not set.
inline std::vector<std::filesystem::path> search_path(const char* variable) {
  std::vector<std::filesystem::path> folders;
  const char* value = std::getenv(variable);
  std::string_view left = value == nullptr ? "" : value;
  while (!left.empty()) {
    const std::string_view folder = left.substr(0, left.find(':'));
    if (!folder.empty()) folders.emplace_back(folder);
    left.remove_prefix(std::min(folder.size() + 1, left.size()));
  }
  return folders;
}

}  // namespace limpid
