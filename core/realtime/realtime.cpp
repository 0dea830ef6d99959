#include "core/realtime/realtime.h"

#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/realtime/memory_lock.h"

namespace limpid {
namespace {

constexpr int kPriority = 80;
constexpr int kRtkitPriority = 15;           // rtkit grants 20 at most
constexpr rlim_t kRtkitTimeLimit = 190'000;  // [us], rtkit demands 200 ms at most

bool become_fifo(int priority) {
  const sched_param param{.sched_priority = priority};
  return sched_setscheduler(0, SCHED_FIFO, &param) == 0;
}

// The highest priority the process may take without privilege, up to kPriority; 0 for none.
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
    report.explanation = "real-time through rtkit, priority " + std::to_string(kRtkitPriority);
    return;
  }
  report.explanation = "no real-time priority: RLIMIT_RTPRIO forbids it";
  report.explanation += ask ? " and rtkit did not grant it" : " and rtkit was not asked";
}

// A thread starts as the one that made it, which may have stepped back. The system lets only the
// privileged forward again.
void step_forward() {
  const sched_param param{};
  if (sched_getscheduler(0) == SCHED_IDLE) sched_setscheduler(0, SCHED_OTHER, &param);
}

}  // namespace

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
