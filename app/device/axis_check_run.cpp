#include "app/device/axis_check_run.h"

#include <fmt/format.h>

#include <thread>

#include "core/realtime/haptic_thread.h"
#include "core/tick/safety.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kTick{1};
constexpr milliseconds kSilence{400};

}  // namespace

AxisCheck run_axis_check(Device& device, AxisCheckTalk& talk, const AskForPriority& ask) {
  AxisCheck check(device.traits());
  const auto joints = static_cast<std::size_t>(device.traits().dof);
  std::atomic<bool> done = false;
  {
    HapticThread thread(ask);
    const auto tick = [&](const TickTiming& timing) {
      if (done) return;
      if (talk.cancel) check.cancel();
      DeviceReading reading;
      const bool here = device.read(reading);
      const bool well =
          here && reading.hand && !reading.fault && reading.age <= SafetyLimits::kStaleReading;
      device.write(check.step({std::span(reading.x).first(joints), timing.periods * 1e-3, well}));
      talk.axis = check.axis();
      talk.stage = check.stage();
      done = check.done();
    };
    thread.start(kTick, tick, Overdue::given_up);
    while (!done && thread.status().running) {
      std::this_thread::sleep_for(milliseconds(10));
      if (std::chrono::steady_clock::now() - talk.window_seen.load() > kSilence) talk.cancel = true;
    }
  }
  device.stop();
  return check;
}

std::string report_of(const AxisCheck& check) {
  std::string text;
  for (int i = 0; i < check.dof(); ++i) {
    text +=
        fmt::format("{}axis {}: {}", i == 0 ? "" : "\n", i + 1, explain(check.finding(i).verdict));
  }
  return text;
}

}  // namespace limpid
