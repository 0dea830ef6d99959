#include "app/desktop/device_desk.h"

#include <fmt/format.h>

#include "app/desktop/workbench.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{1000};   // between two looks at what is plugged in
constexpr milliseconds kRetry{3000};  // after a device could not be opened
constexpr milliseconds kSettle{500};  // until the loop shows whether a new device answers

// What stays off until the user arms it again.
bool tripped(ForceState state) {
  return state == ForceState::lost || state == ForceState::stale || state == ForceState::fault ||
         state == ForceState::energy;
}

}  // namespace

DeviceDesk::DeviceDesk(AskForPriority ask) : hub(device_book_file(), std::move(ask)) {}

void DeviceDesk::update(Workbench& bench) {
  const auto now = Clock::now();
  if (now >= look_at_) {
    hub.look();
    look_at_ = now + kLook;
  }
  if (bench.live.device_plugged()) {
    watch(bench);
    return;
  }
  if (hub.in_use().empty() || now < retry_at_) return;
  const FoundDevice* found = hub.present();
  if (found == nullptr) {
    problem_ = "not connected";
  } else if (!found->missing.empty()) {
    problem_ = found->missing;
  } else {
    connect(bench);
  }
}

void DeviceDesk::watch(Workbench& bench) {
  const Snapshot& snapshot = bench.live.snapshot();
  if (Clock::now() < plugged_at_ + kSettle) return;
  if (bench.live.real() && bench.controls.force && tripped(snapshot.force_state)) {
    bench.cut_force();
    bench.say(fmt::format("Force is off: {}. F arms it again.", explain(snapshot.force_state)),
              true);
  }
  if (!snapshot.connected) {
    problem_ = "not connected";
    bench.cut_force();
    bench.say("The device is gone. It is taken up again when it comes back, without force.", true);
    bench.live.plug(nullptr);
    return;
  }
  const std::uint32_t pressed = snapshot.reading.buttons & ~buttons_;
  buttons_ = snapshot.reading.buttons;
  if ((pressed & 1) != 0) bench.toggle_coupling();
  if ((pressed & 2) != 0) bench.toggle_force();
}

void DeviceDesk::connect(Workbench& bench) {
  try {
    std::unique_ptr<Device> device = hub.open();
    const DeviceTraits traits = device->traits();
    bench.open_device(std::move(device));
    problem_.clear();
    buttons_ = 0;
    plugged_at_ = Clock::now();
    bench.say(traits.pushes
                  ? fmt::format("{} is in the loop. Take it in your hand, then F arms the force.",
                                traits.name)
                  : fmt::format("{} leads the hand.", traits.name));
  } catch (const std::exception& e) {
    problem_ = e.what();
    retry_at_ = Clock::now() + kRetry;
  }
}

void DeviceDesk::use(Workbench& bench, const std::string& id) {
  if (bench.live.recording()) {
    bench.say("Stop the recording before changing the device.", true);
    return;
  }
  if (id == hub.in_use()) return;
  hub.use(id);
  problem_.clear();
  retry_at_ = {};
  bench.close_device();
  if (const std::string error = hub.save(); !error.empty()) bench.say(error, true);
}

void DeviceDesk::connect_anew(Workbench& bench) {
  if (const std::string error = hub.save(); !error.empty()) bench.say(error, true);
  if (!bench.live.device_plugged()) return;
  bench.cut_force();
  bench.live.plug(nullptr);
  retry_at_ = Clock::now() + milliseconds(100);  // the loop gives the old one back first
}

}  // namespace limpid
