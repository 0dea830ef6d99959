#include "devices/hid/guardian.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include "devices/hid/hid_transport.h"

namespace limpid {

// Memory that both processes see. The watched thread holds the lock; its end releases the lock,
// marked as such by the kernel.
struct Guardian::Watch {
  pthread_mutex_t alive;
  std::atomic<bool> independent{false}, held{false}, dismissed{false};

  Watch() {
    pthread_mutexattr_t kind;
    pthread_mutexattr_init(&kind);
    pthread_mutexattr_setpshared(&kind, PTHREAD_PROCESS_SHARED);
    pthread_mutexattr_setrobust(&kind, PTHREAD_MUTEX_ROBUST);
    pthread_mutex_init(&alive, &kind);
    pthread_mutexattr_destroy(&kind);
  }
  void hold() {
    pthread_mutex_lock(&alive);
    held = true;
  }
  // Waits in the child process until the watched thread releases the lock or ends.
  void wait_for_end(pid_t parent) {
    while (!held && getppid() == parent) poll(nullptr, 0, 1);
    pthread_mutex_lock(&alive);
  }
};

namespace {

constexpr int kReportTries = 3;  // for each report

int open_node(const std::string& path) {
  const int device = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (device < 0) throw HidError(fmt::format("{}: {}", path, std::strerror(errno)));
  return device;
}

// Forks a child that hears no signals from its first moment on: it must outlive Ctrl-C.
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

// Outlives the end of the terminal. This and the next two functions run in the child, a copy of one
// thread of many: they may neither allocate nor take a lock of the process.
void become_independent() {
  setsid();
  prctl(PR_SET_NAME, "limpid-guardian");
}

// Closes the window's and other devices' files.
void close_all_but(int device, int claim) {
  unsigned next = 0;
  for (const int file : {std::min(device, claim), std::max(device, claim)}) {
    if (file < 0) continue;
    const auto kept = static_cast<unsigned>(file);
    if (kept > next) close_range(next, kept - 1, 0);
    next = kept + 1;
  }
  close_range(next, ~0u, 0);
}

void stop_device(int device, const std::vector<Report>& reports) {
  for (const Report& report : reports) {
    for (int i = 0; i < kReportTries && write(device, report.data(), report.size()) < 0; ++i) {
      poll(nullptr, 0, 2);
    }
  }
}

// Lowers this process' limit of core dumps to 1 byte, which Linux takes for none at all. At 0 it
// would still pipe them into a program.
void leave_no_core_dump() {
  rlimit core{};
  if (getrlimit(RLIMIT_CORE, &core) != 0) return;
  core.rlim_cur = std::min<rlim_t>(1, core.rlim_max);
  setrlimit(RLIMIT_CORE, &core);
}

}  // namespace

Guardian::Guardian(const std::string& path, const std::vector<Report>& stop_reports, int claim)
    : Guardian(open_node(path), stop_reports, claim) {}

Guardian::Guardian(int device, const std::vector<Report>& stop_reports, int claim) {
  void* const page =
      mmap(nullptr, sizeof(Watch), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  const pid_t parent = getpid();
  if (page != MAP_FAILED) {
    watch_ = new (page) Watch;
    child_ = fork_deaf();
  }
  if (child_ == 0) {
    become_independent();
    close_all_but(device, claim);
    watch_->independent = true;
    watch_->wait_for_end(parent);
    if (!watch_->dismissed) stop_device(device, stop_reports);
    _exit(0);
  }
  const int error = errno;
  close(device);
  if (child_ > 0) {
    leave_no_core_dump();
    // Waits: until the child is independent, whatever kills our group or hangs up our terminal
    // kills it, too.
    while (!watch_->independent && waitpid(child_, nullptr, WNOHANG) == 0) poll(nullptr, 0, 1);
    watch_->hold();
    return;
  }
  if (watch_ != nullptr) munmap(watch_, sizeof(Watch));
  throw HidError(fmt::format("the process that guards the device cannot be started: {}",
                             std::strerror(error)));
}

Guardian::~Guardian() {
  pthread_mutex_unlock(&watch_->alive);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  munmap(watch_, sizeof(Watch));
}

void Guardian::dismiss() noexcept { watch_->dismissed = true; }

}  // namespace limpid
