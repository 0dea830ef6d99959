#include "core/realtime/realtime.h"

#include <link.h>
#include <linux/capability.h>
#include <malloc.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/large_memory.h"

namespace limpid {

namespace {

bool has_capability(unsigned capability) {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, 2> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return (data[capability / 32].effective >> (capability % 32)) & 1u;
}

// True if the process may lock all its memory. Under a finite limit, locking future mappings makes
// the OpenGL driver's allocations fail, and a locked stack cannot grow.
bool may_lock_everything() {
  if (has_capability(CAP_IPC_LOCK)) return true;
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_max != RLIM_INFINITY) return false;
  limit.rlim_cur = RLIM_INFINITY;
  return setrlimit(RLIMIT_MEMLOCK, &limit) == 0;
}

// True for the program itself, whose name is empty here, and for the libraries that ticks call.
bool is_run_by_ticks(std::string_view file) {
  constexpr std::array<std::string_view, 9> kLibraries = {
      "libc.so",  "libm.so",    "libstdc++.so", "libgcc_s.so", "libpthread.so",
      "ld-linux", "linux-vdso", "libhidapi",    "libudev.so"};
  file.remove_prefix(file.rfind('/') + 1);
  return file.empty() || std::ranges::any_of(kLibraries, [&](std::string_view library) {
           return file.starts_with(library);
         });
}

// Loads an object's segments by locking them one by one: MCL_ONFAULT alone loads nothing.
int bring_in(dl_phdr_info* object, std::size_t, void* done) {
  if (!is_run_by_ticks(object->dlpi_name)) return 0;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD) continue;
    const std::uintptr_t from = (object->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t to = object->dlpi_addr + segment.p_vaddr + segment.p_memsz;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the loader tells where things are.
    if (mlock(reinterpret_cast<const void*>(from), to - from) != 0)
      *static_cast<bool*>(done) = false;
  }
  return 0;
}

constexpr int kPriority = 80;
constexpr int kRtkitPriority = 15;           // rtkit grants 20 at most
constexpr rlim_t kRtkitTimeLimit = 190'000;  // [us], rtkit demands 200 ms at most

bool become_fifo(int priority) {
  const sched_param param{.sched_priority = priority};
  return sched_setscheduler(0, SCHED_FIFO, &param) == 0;
}

// Highest priority the process may take without privilege, up to kPriority; 0 for none.
int permitted_priority() {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0) return 0;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, kPriority));
}

// rtkit helps only processes that the kernel stops when a real-time thread runs away.
bool become_realtime_by_asking(const AskForPriority& ask) {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTTIME, &limit) != 0) return false;
  limit.rlim_max = std::min(limit.rlim_max, kRtkitTimeLimit);
  limit.rlim_cur = std::min(limit.rlim_cur, limit.rlim_max);
  return setrlimit(RLIMIT_RTTIME, &limit) == 0 && ask(gettid(), kRtkitPriority);
}

[[gnu::noinline]] void touch_stack() {
  constexpr std::size_t kPage = 4096;
  std::array<volatile std::byte, 64 * kPage> stack;
  for (std::size_t i = 0; i < stack.size(); i += kPage) stack[i] = std::byte{0};
}

void set_priority(RealtimeReport& report, const AskForPriority& ask) {
  for (const int priority : {kPriority, permitted_priority()}) {
    if (priority == 0 || !become_fifo(priority)) continue;
    report.scheduling = Scheduling::fifo;
    report.priority = priority;
    report.explanation = "real-time, SCHED_FIFO " + std::to_string(priority);
    return;
  }
  if (ask && become_realtime_by_asking(ask)) {
    report.scheduling = Scheduling::rtkit;
    report.priority = kRtkitPriority;
    report.explanation =
        "real-time by the service rtkit, priority " + std::to_string(kRtkitPriority);
    return;
  }
  report.explanation = "no real-time priority: RLIMIT_RTPRIO forbids it";
  report.explanation +=
      ask ? " and rtkit did not grant it" : " and the service rtkit was not asked";
}

// Undoes yield_to_haptics() of the thread that made this one. The system allows that only to the
// privileged.
void step_forward() {
  const sched_param param{};
  if (sched_getscheduler(0) == SCHED_IDLE) sched_setscheduler(0, SCHED_OTHER, &param);
}

}  // namespace

bool lock_memory() {
  if (!may_lock_everything() || mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) return false;
  unlock_large_blocks();
  bool done = true;
  dl_iterate_phdr(bring_in, &done);
  return done;
}

void give_back_what_is_freed() { mallopt(M_MMAP_THRESHOLD, 128 << 10); }

void keep_what_is_freed() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the highest that glibc takes
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

RealtimeReport become_realtime(const AskForPriority& ask) {
  step_forward();
  prctl(PR_SET_TIMERSLACK, 1UL);
  RealtimeReport report;
  report.memory_locked = lock_memory();
  touch_stack();
  set_priority(report, ask);
  report.explanation += report.memory_locked ? "; memory locked" : "; memory not locked";
  return report;
}

bool yield_to_haptics() noexcept {
  const sched_param param{};
  return sched_setscheduler(0, SCHED_IDLE, &param) == 0;
}

}  // namespace limpid
