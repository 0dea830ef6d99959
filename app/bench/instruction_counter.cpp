#include "app/bench/instruction_counter.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace limpid::bench {
namespace {

int open_counter() {
  perf_event_attr event{};
  event.type = PERF_TYPE_HARDWARE;
  event.size = sizeof event;
  event.config = PERF_COUNT_HW_INSTRUCTIONS;
  event.disabled = 1;
  event.exclude_kernel = 1;
  event.exclude_hv = 1;
  return static_cast<int>(syscall(SYS_perf_event_open, &event, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
}

}  // namespace

InstructionCounter::InstructionCounter() : file_(open_counter()) {}

InstructionCounter::~InstructionCounter() {
  if (counts()) close(file_);
}

void InstructionCounter::start() const {
  if (counts()) ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
}

void InstructionCounter::stop() const {
  if (counts()) ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
}

std::optional<std::uint64_t> InstructionCounter::total() const {
  std::uint64_t count = 0;
  if (!counts() || read(file_, &count, sizeof count) != sizeof count) return std::nullopt;
  return count;
}

}  // namespace limpid::bench
