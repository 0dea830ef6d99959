#include "devices/files/session/session_place.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>

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

fs::path recovered_name(const fs::path& part) {
  if (part.extension() != kPart || part.stem().empty()) {
    throw FileError(fmt::format("{}: not the .part file of a recording", part.string()));
  }
  return part.parent_path() / part.stem();
}

void check_place(const fs::path& out, bool force) {
  std::error_code error;
  if (out.filename().empty()) {
    throw FileError(fmt::format("'{}': not the name of a file", out.string()));
  }
  if (fs::is_directory(out, error)) {
    throw FileError(fmt::format("{}: is a directory", out.string()));
  }
  if (!force && fs::exists(out, error)) {
    throw FileError(fmt::format("{}: exists; --force overwrites it", out.string()));
  }
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

void check_session_info(const SessionInfo& info, const fs::path& file) {
  if (!(info.tick > 0 && info.tick <= 0.1)) {
    throw FileError(
        fmt::format("{}: tick {} s; allowed: more than 0, up to 0.1", file.string(), info.tick));
  }
  if (info.dof < 1 || info.dof > kMaxDof) {
    throw FileError(fmt::format("{}: dof {}; allowed: 1 to {}", file.string(), info.dof, kMaxDof));
  }
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

WriteLock::WriteLock(const fs::path& file, Make make)
    : descriptor_(
          ::open(file.c_str(), O_RDWR | O_CLOEXEC | (make == Make::yes ? O_CREAT : 0), 0644)) {
  if (descriptor_ < 0) fail(file, "cannot open", errno);
  // A lock of the open file, not of the process, so that it works between threads too; HDF5's own
  // locks (flock) are of another kind and do not meet it.
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  if (::fcntl(descriptor_, F_OFD_SETLK, &whole) != 0) {
    const int code = errno;
    ::close(descriptor_);
    if (code == EAGAIN || code == EACCES) {
      throw FileError(fmt::format("{}: is still being recorded", file.string()));
    }
    fail(file, "cannot lock", code);
  }
}

WriteLock::~WriteLock() { ::close(descriptor_); }

}  // namespace limpid
