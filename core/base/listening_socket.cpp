#include "core/base/listening_socket.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>

namespace limpid {

int listen_under(const std::filesystem::path& path, int kind, int waiting) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string unready = path.parent_path() / ("." + std::to_string(getpid()));
  if (unready.size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return -1;
  }
  unready.copy(address.sun_path, unready.size());
  unlink(unready.c_str());
  const int file = socket(AF_UNIX, kind | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (file >= 0 && bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      chmod(unready.c_str(), 0600) == 0 && listen(file, waiting) == 0 &&
      rename(unready.c_str(), path.c_str()) == 0) {
    return file;
  }
  const int error = errno;
  unlink(unready.c_str());
  if (file >= 0) close(file);
  errno = error;
  return -1;
}

}  // namespace limpid
