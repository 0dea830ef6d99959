#include "app/cli/out_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <vector>

#include "app/cli/options.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

// Tries a file there, so that what forbids it is known. 0, or errno.
int try_to_write(const fs::path& dir) {
  const std::string probe = (dir / fmt::format(".{}.probe", getpid())).string();
  const int descriptor = open(probe.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) return errno;
  const std::vector<char> some(1 << 16);
  errno = ENOSPC;  // what a short write means
  const bool written =
      ::write(descriptor, some.data(), some.size()) == std::ssize(some) && fsync(descriptor) == 0;
  const int code = written ? 0 : errno;
  close(descriptor);
  unlink(probe.c_str());
  return code;
}

}  // namespace

void prepare_out(const fs::path& dir) {
  std::error_code error;
  const bool created = fs::create_directories(dir, error);
  if (!error && !fs::is_directory(dir)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error) error = {try_to_write(dir), std::generic_category()};
  if (!error) return;
  std::error_code none;
  if (created) fs::remove(dir, none);
  throw UsageError(fmt::format("--out {}: {}", dir.string(), error.message()));
}

}  // namespace limpid
