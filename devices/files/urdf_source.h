// URDF files as they lie on the disk: plain ones, and xacro's, which have to be expanded.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "devices/files/urdf_file.h"

namespace limpid {

// Folders that an environment variable lists.

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

// A look through an XML text before it is parsed: TinyXML recurses for each element inside of
// another one, and compares each attribute with all others of its element.
inline constexpr std::size_t kLongestXml = 16 << 20;  // [bytes]

// Errors: FileError naming `where` for texts that are too long, nested too deep, or have too many
// attributes in an element, as TinyXML reads them.
void check_xml(const std::string& text, const std::string& where);

// The URDF text of a file. One that is written in xacro (FILE.xacro, or macros inside) goes through
// the program `xacro`, if that is installed and `xacro` says that it may; any encoding becomes
// UTF-8. Errors: XacroToExpand where it may not; FileError for files that cannot be read or are
// longer than 16 MiB; for xacro without the program, saying how to expand it, or with what the
// program complains of.
std::string urdf_text(const std::filesystem::path& file, Xacro xacro);

}  // namespace limpid
