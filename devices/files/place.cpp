#include "devices/files/place.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "devices/files/file_error.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPart = ".part";

[[noreturn]] void fail(const fs::path& file, const char* what, int code) {
  throw FileError(fmt::format("{}: {}: {}", file.string(), what, std::strerror(code)));
}

fs::path directory_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void sync(const fs::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail(file, "cannot open", errno);
  const int code = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (code != 0) fail(file, "cannot write", code);
}

}  // namespace

fs::path part_of(const fs::path& out) {
  fs::path part = out;
  part += kPart;
  return part;
}

void check_folder(const fs::path& out) {
  std::error_code error;
  const fs::path directory = directory_of(out);
  if (const std::string why = why_not_found(directory, "no such directory"); !why.empty()) {
    throw FileError(fmt::format("{}: {}: {}", out.string(), why, directory.string()));
  }
  if (!fs::is_directory(directory, error)) {
    throw FileError(fmt::format("{}: not a directory: {}", out.string(), directory.string()));
  }
  if (::faccessat(AT_FDCWD, directory.c_str(), W_OK | X_OK, AT_EACCESS) != 0)
    fail(out, "cannot write there", errno);
}

void check_place(const fs::path& out, bool force) {
  std::error_code error;
  if (out.filename().empty()) {
    throw FileError(fmt::format("'{}': not the name of a file", out.string()));
  }
  if (fs::is_directory(out, error)) {
    throw FileError(fmt::format("{}: is a directory", out.string()));
  }
  if (fs::exists(out, error) && !fs::is_regular_file(out, error)) {
    throw FileError(
        fmt::format("{}: is no ordinary file, and would be replaced by one", out.string()));
  }
  if (!force && fs::exists(out, error)) {
    throw FileError(fmt::format("{}: exists; --force overwrites it", out.string()));
  }
  check_folder(out);
}

void publish(const fs::path& finished, const fs::path& out, bool force) {
  sync(finished, O_RDWR);
  std::error_code error;
  if (!force && fs::exists(out, error)) {
    throw FileError(fmt::format("{}: appeared meanwhile and was left alone; --force overwrites it",
                                out.string()));
  }
  fs::rename(finished, out, error);
  if (error) fail(out, "cannot rename to it", error.value());
  sync(directory_of(out), O_RDONLY | O_DIRECTORY);
}

}  // namespace limpid
