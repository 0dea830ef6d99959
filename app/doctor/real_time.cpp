#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "app/doctor/doctor.h"
#include "app/live/rtkit.h"
#include "core/realtime/realtime.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using State = Finding::State;

constexpr const char* kRealTimeArea = "real time";
constexpr const char* kGroup = "realtime";  // as in assets/desktop/limits.conf

std::string first_line(const fs::path& file) {
  std::ifstream text(file);
  std::string line;
  std::getline(text, line);
  return line;
}

std::string limit_text(int resource, const char* unit, rlim_t per) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) return "unknown";
  if (limit.rlim_cur == RLIM_INFINITY) return "unlimited";
  return fmt::format("{}{}", limit.rlim_cur / per, unit);
}

std::string user() {
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? entry->pw_name : "$USER";
}

// Command that adds the user to the group of the package's limits; without the package, one that
// gives the user the limits by name.
std::string mend_limits() {
  if (fs::exists("/etc/security/limits.d/limpid.conf") && getgrnam(kGroup) != nullptr) {
    return fmt::format("sudo usermod -aG {} {}    # then log in again", kGroup, user());
  }
  return fmt::format(
      "printf '{0} - rtprio 80\\n{0} - memlock unlimited\\n' | sudo tee "
      "/etc/security/limits.d/limpid-{0}.conf    # allows real-time priority and locked memory; "
      "then log in again",
      user());
}

struct Granted {
  RealtimeReport report;
  int timer_slack = 0;  // [ns]
};

// Asks in a thread that ends at once, so that this one stays as it is.
Granted ask_for_all() {
  Granted granted;
  std::thread([&granted] {
    granted.report = become_realtime(by_rtkit());
    granted.timer_slack = prctl(PR_GET_TIMERSLACK);
  }).join();
  return granted;
}

Finding priority(const RealtimeReport& report) {
  const std::string found = fmt::format("{} (RLIMIT_RTPRIO {})",
                                        report.explanation.substr(0, report.explanation.find(';')),
                                        limit_text(RLIMIT_RTPRIO, "", 1));
  if (report.realtime()) return {kRealTimeArea, "priority", State::fine, found, {}, {}};
  return {kRealTimeArea,
          "priority",
          State::better,
          found,
          "ticks come late whenever the computer is busy",
          mend_limits()};
}

Finding memory(const RealtimeReport& report) {
  const std::string limit = limit_text(RLIMIT_MEMLOCK, " KiB", 1024);
  if (report.memory_locked) {
    return {kRealTimeArea,
            "memory",
            State::fine,
            fmt::format("is locked, and is never moved to the disk (RLIMIT_MEMLOCK {})", limit),
            {},
            {}};
  }
  return {kRealTimeArea,
          "memory",
          State::better,
          fmt::format("is not locked, and may be moved to the disk (RLIMIT_MEMLOCK {})", limit),
          "a tick is late if Limpid's memory was moved to the disk",
          mend_limits()};
}

Finding timers(int slack) {
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  const std::string found = fmt::format("every {} ns, slack {} ns", resolution.tv_nsec, slack);
  // Real-time threads have no slack, whatever was asked for.
  const bool fine =
      resolution.tv_sec == 0 && resolution.tv_nsec < 1'000'000 && (slack == 0 || slack == 1);
  if (fine) return {kRealTimeArea, "timers", State::fine, found, {}, {}};
  return {kRealTimeArea,
          "timers",
          State::broken,
          found,
          "1000 ticks per second are not reached",
          "a kernel with CONFIG_HIGH_RES_TIMERS, for example Debian's: sudo apt install "
          "linux-image-amd64"};
}

Finding governor() {
  std::map<std::string, int> processors;  // by governor
  std::error_code none;
  for (fs::directory_iterator cpu("/sys/devices/system/cpu", none), end; !none && cpu != end;
       cpu.increment(none)) {
    const std::string name = first_line(cpu->path() / "cpufreq/scaling_governor");
    if (!name.empty()) ++processors[name];
  }
  if (processors.empty()) {
    return {kRealTimeArea,
            "clock",
            State::fine,
            "the kernel does not control the processor's frequency",
            {},
            {}};
  }
  std::string found;
  for (const auto& [name, count] : processors) {
    found += fmt::format("{}{} on {}", found.empty() ? "" : ", ", name, count);
  }
  found += processors.size() == 1 && processors.begin()->second == 1 ? " processor" : " processors";
  if (!processors.contains("powersave") && !processors.contains("conservative")) {
    return {kRealTimeArea, "clock", State::fine, found, {}, {}};
  }
  return {kRealTimeArea,
          "clock",
          State::better,
          found,
          "ticks take longer while the processor's frequency rises",
          "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

// Names the kernel; always fine, as SCHED_FIFO suffices with any on most computers.
Finding kernel() {
  utsname name{};
  uname(&name);
  const std::string version = name.version;
  std::string kind = "no PREEMPT";
  for (const char* known : {"PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT"}) {
    if (version.find(known) == std::string::npos) continue;
    kind = known;
    break;
  }
  if (kind != "PREEMPT_RT")
    kind += "; linux-image-rt-amd64 has PREEMPT_RT, with the fewest late ticks";
  return {kRealTimeArea,
          "kernel",
          State::fine,
          fmt::format("Linux {}, {}", name.release, kind),
          {},
          {}};
}

}  // namespace

DoctorFindings look_at_real_time() {
  const Granted granted = ask_for_all();
  return {priority(granted.report), memory(granted.report), timers(granted.timer_slack), governor(),
          kernel()};
}

}  // namespace limpid
