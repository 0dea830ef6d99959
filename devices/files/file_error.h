// The one error of everything that reads or writes files.
#pragma once

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace limpid {

// What is in a file may hold anything; a message is one line.
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

// Why there is nothing to be found at `path`, in the system's words or as `absent` if it is simply
// not there; empty if there is something.
inline std::string why_not_found(const std::filesystem::path& path, const std::string& absent) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return {};
  return errno == ENOENT || errno == ENOTDIR ? absent : std::strerror(errno);
}

}  // namespace limpid
