#include "core/realtime/clock.h"

#include <cerrno>
#include <ctime>

namespace limpid {

nanoseconds MonotonicTime::now() const noexcept {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + nanoseconds(t.tv_nsec);
}

void MonotonicTime::sleep_until(nanoseconds moment) const noexcept {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(moment);
  const timespec t{.tv_sec = whole.count(), .tv_nsec = (moment - whole).count()};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace limpid
