// URDF files on the disk: plain ones, and xacro files, which have to be expanded.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "devices/files/urdf_file.h"

namespace limpid {

// Folders that an environment variable lists as PATH does, with colons; none if it is not set.
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

// Longest XML text that is parsed.
inline constexpr std::size_t kLongestXml = 16 << 20;  // [bytes]

// Checks an XML text before TinyXML, which recurses for nested elements and compares each attribute
// with all others of its element. Errors: FileError naming `where` for texts that are too long,
// nested too deep, or have too many attributes in an element, as TinyXML reads them.
void check_xml(const std::string& text, const std::string& where);

// The URDF text of a file, in UTF-8 whatever its encoding. A xacro file (FILE.xacro, or macros
// inside) is expanded by the program `xacro`, if `xacro` permits it. Errors: XacroToExpand without
// permission; FileError for files that cannot be read or are longer than 16 MiB. Also FileError for
// xacro without the program, saying how to expand it, and with the program's complaint.
std::string urdf_text(const std::filesystem::path& file, Xacro xacro);

}  // namespace limpid
