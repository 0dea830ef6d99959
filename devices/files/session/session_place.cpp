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

}  // namespace

fs::path recovered_name(const fs::path& part) {
  if (part.extension() != kPart || part.stem().empty()) {
    throw FileError(fmt::format("{}: not the .part file of a recording", part.string()));
  }
  return part.parent_path() / part.stem();
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
