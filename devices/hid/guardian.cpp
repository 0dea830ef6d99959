#include "devices/hid/guardian.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "devices/hid/hid_error.h"

namespace limpid {
namespace {

constexpr int kTries = 3;  // of each report

int open_locked(const std::string& path) {
  const int device = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (device < 0) throw HidError(fmt::format("{}: {}", path, std::strerror(errno)));
  if (flock(device, LOCK_EX | LOCK_NB) != 0) {
    close(device);
    throw HidError(fmt::format("{}: another Limpid uses this device", path));
  }
  return device;
}

// A guardian hears no signals from its first moment on: it must outlive Ctrl-C.
pid_t fork_deaf() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t child = fork();
  const int error = errno;
  if (child != 0) pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return child;
}

// What follows runs in the child: it is a copy of one thread of a process with many, so it may call
// nothing but async-signal-safe functions. No allocation, no locks, no exceptions.

// It must outlive the end of the terminal.
void become_independent() {
  setsid();
  prctl(PR_SET_NAME, "limpid-guardian");
}

// Above all it must not hold our side of this or of another guardian's socket: that would never
// close.
void close_all_but(int one, int other) {
  const auto low = static_cast<unsigned>(std::min(one, other));
  const auto high = static_cast<unsigned>(std::max(one, other));
  if (low > 0) close_range(0, low - 1, 0);
  if (high - low > 1) close_range(low + 1, high - 1, 0);
  close_range(high + 1, ~0u, 0);
}

bool dismissed(int socket) {
  char word = 0;
  ssize_t size;
  do size = read(socket, &word, 1);
  while (size < 0 && errno == EINTR);
  return size == 1;
}

void stop_device(int device, const std::vector<Report>& reports) {
  for (const Report& report : reports) {
    for (int i = 0; i < kTries && write(device, report.data(), report.size()) < 0; ++i) {
      poll(nullptr, 0, 2);
    }
  }
}

[[noreturn]] void guard(int socket, int device, const std::vector<Report>& stop_reports) {
  become_independent();
  close_all_but(socket, device);
  if (!dismissed(socket)) stop_device(device, stop_reports);
  _exit(0);
}

}  // namespace

Guardian::Guardian(const std::string& path, const std::vector<Report>& stop_reports)
    : Guardian(open_locked(path), stop_reports) {}

Guardian::Guardian(int device, const std::vector<Report>& stop_reports) {
  int sockets[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) == 0) child_ = fork_deaf();
  if (child_ == 0) guard(sockets[1], device, stop_reports);
  const int error = errno;
  close(device);
  if (sockets[1] >= 0) close(sockets[1]);
  socket_ = sockets[0];
  if (child_ > 0) return;
  if (socket_ >= 0) close(socket_);
  throw HidError(fmt::format("no process to guard the device: {}", std::strerror(error)));
}

Guardian::~Guardian() {
  close(socket_);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void Guardian::dismiss() noexcept {
  // A guardian that somebody killed is no reason to die of SIGPIPE.
  const char word = 'q';
  while (send(socket_, &word, 1, MSG_NOSIGNAL) < 0 && errno == EINTR) {
  }
}

}  // namespace limpid
