// The one error of everything that reads or writes files.
#pragma once

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace limpid {

// A file that cannot be read or written; what() names it and says why.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Why there is nothing to be found at `path`, in the system's words or as `absent` if it is simply
// not there; empty if there is something.
inline std::string why_not_found(const std::filesystem::path& path, const std::string& absent) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return {};
  return errno == ENOENT || errno == ENOTDIR ? absent : std::strerror(errno);
}

}  // namespace limpid
