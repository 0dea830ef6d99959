// Text files read whole, and FileError, the one error of all that reads or writes files.
#pragma once

#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace limpid {

// `text` in one line: control characters, as files may hold them, become blanks.
inline std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  return text;
}

// A file that cannot be read or written; what() names it and says why, in one line.
struct FileError : std::runtime_error {
  explicit FileError(const std::string& what) : std::runtime_error(one_line(what)) {}
};

// The reason why nothing is found at `path`: `absent` if nothing is there, else the system's words.
// Empty if something is found.
inline std::string why_not_found(const std::filesystem::path& path, const std::string& absent) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return {};
  return errno == ENOENT || errno == ENOTDIR ? absent : std::strerror(errno);
}

// The text of a regular file, without a UTF-8 byte order mark. Errors: FileError for a file that
// is missing, no regular file, unreadable or longer than `limit` bytes.
std::string read_text(const std::filesystem::path& file, std::size_t limit);

// Characters that trimmed() takes off the ends of a text: blanks, tabs and carriage returns.
inline constexpr std::string_view kBlanks = " \t\r";
std::string_view trimmed(std::string_view text);

}  // namespace limpid
