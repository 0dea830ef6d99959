#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "app/bench/bench.h"
#include "app/bench/instruction_counter.h"
#include "app/live/rtkit.h"
#include "core/realtime/realtime.h"

namespace limpid::bench {
namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

// In a thread that ends at once: this one stays as it is.
std::string granted() {
  std::string said;
  std::thread([&said] { said = become_realtime(by_rtkit()).explanation; }).join();
  return said.substr(0, said.find(';'));
}

}  // namespace

Machine this_machine() {
  utsname name{};
  uname(&name);
  return {
    processor(), static_cast<int>(std::thread::hardware_concurrency()),
        fmt::format("{} {} {}", name.sysname, name.release, name.machine),
#if defined(__clang__)
        fmt::format("clang {}", __clang_version__),
#else
        fmt::format("gcc {}", __VERSION__),
#endif
        granted(), InstructionCounter().counts()
  };
}

}  // namespace limpid::bench
