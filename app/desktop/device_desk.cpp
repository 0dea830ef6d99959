#include "app/desktop/device_desk.h"

#include <fmt/format.h>

#include "app/desktop/workbench.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{1000};   // between two looks at what is plugged in
constexpr milliseconds kRetry{3000};  // after a device could not be opened
constexpr milliseconds kSettle{500};  // until the loop shows whether a new device answers

}  // namespace

DeviceDesk::DeviceDesk(AskForPriority ask) : hub(device_book_file(), std::move(ask)) {}

void DeviceDesk::update(Workbench& bench) {
  look(bench);
  take_connected(bench);
  follow_check(bench);
  if (bench.live.device_in_place()) bench.controls.limits = hub.notes(hub.in_use()).limits;
  if (bench.live.device_plugged()) return watch(bench);
  if (hub.in_use().empty() || connecting_.valid() || check_.valid() || Clock::now() < retry_at_) {
    return;
  }
  const FoundDevice* found = hub.present();
  if (found == nullptr) {
    problem_ = "not connected";
  } else if (!found->missing.empty()) {
    problem_ = found->missing;
  } else if (hub.needs_check()) {
    if (problem_.empty()) problem_ = "Its axes have to be checked before it may push.";
  } else if (must_wait(bench)) {
    problem_ = "waits for the end of the recording";
  } else {
    connect(bench);
  }
}

bool DeviceDesk::must_wait(const Workbench& bench) const {
  const FoundDevice* found = hub.present();
  return bench.recording() && !bench.live.device_in_place() && found != nullptr &&
         !found->kind->leads_hand;
}

void DeviceDesk::look(Workbench& bench) {
  if (auto found = take_ready(looking_)) hub.take(std::move(*found));
  if (looking_.valid() || Clock::now() < look_at_) return;
  looking_ = bench.device_errands.run([] { return DeviceHub::look(); });
  look_at_ = Clock::now() + kLook;
}

void DeviceDesk::watch(Workbench& bench) {
  const Snapshot& snapshot = bench.live.snapshot();
  if (Clock::now() < plugged_at_ + kSettle) return;
  const Arming before = std::exchange(arming_, snapshot.arming);
  if (bench.live.device_in_place() && arming_ == Arming::tripped && before != Arming::tripped) {
    bench.say(fmt::format("Force is off: {}. F arms it again.", explain(snapshot.force_state)),
              true);
  }
  if (!snapshot.connected) {
    problem_ = "not connected";
    bench.say("The device is gone. It is taken up again when it comes back, without force.", true);
    bench.live.plug(nullptr);
    return;
  }
  const std::uint32_t pressed = buttons_.take(snapshot.reading.buttons);
  if ((pressed & 1) != 0) bench.toggle_coupling();
  if ((pressed & 2) != 0) bench.toggle_force();
}

void DeviceDesk::connect(Workbench& bench) {
  problem_ = "connecting";
  connecting_id_ = hub.in_use();
  connecting_ = bench.device_errands.run(hub.opening());
}

void DeviceDesk::take_connected(Workbench& bench) {
  try {
    auto ready = take_ready(connecting_);
    if (!ready) return;
    if (connecting_id_ != hub.in_use() || must_wait(bench)) {  // meanwhile it is not wanted
      return bench.let_go(std::move(*ready));
    }
    const DeviceTraits traits = (*ready)->traits();
    bench.open_device(std::move(*ready));
    problem_.clear();
    bench.say(traits.pushes
                  ? fmt::format("{} is in the loop. Take it in your hand, then F arms the force.",
                                traits.name)
                  : fmt::format("{} leads the hand.", traits.name));
  } catch (const std::exception& e) {
    problem_ = e.what();
    retry_at_ = Clock::now() + kRetry;
  }
}

void DeviceDesk::save(Workbench& bench) const {
  if (const std::string error = hub.save(); !error.empty()) bench.say(error, true);
}

void DeviceDesk::plugged() {
  buttons_.forget();
  arming_ = Arming::off;
  plugged_at_ = Clock::now();
}

void DeviceDesk::start_check(Workbench& bench) {
  talk_ = std::make_shared<AxisCheckTalk>();
  problem_.clear();
  connecting_id_ = hub.in_use();
  check_ = bench.device_errands.run(hub.checking(talk_));
}

void DeviceDesk::follow_check(Workbench& bench) {
  if (!check_.valid()) return;
  talk_->see_window();
  try {
    const auto check = take_ready(check_);
    if (!check || connecting_id_ != hub.in_use()) return;
    problem_ = report_of(*check);
    if (!remember_check(*check, hub.notes(hub.in_use()))) {
      return bench.say("The check has not passed; the device stays out of the loop.", true);
    }
    bench.say("Its axes move as they are pushed.\n" + problem_);
    problem_.clear();
    save(bench);
  } catch (const std::exception& e) {
    problem_ = e.what();
    retry_at_ = Clock::now() + kRetry;
  }
}

void DeviceDesk::use(Workbench& bench, const std::string& id) {
  if (bench.recording()) {
    bench.say("Stop the recording before changing the device.", true);
    return;
  }
  if (id == hub.in_use()) return;
  hub.use(id);
  cancel_check();
  problem_.clear();
  retry_at_ = {};
  bench.close_device();
  save(bench);
}

void DeviceDesk::connect_anew(Workbench& bench) {
  save(bench);
  if (!bench.live.device_plugged()) return;
  bench.cut_force();
  bench.live.plug(nullptr);
  retry_at_ = Clock::now() + milliseconds(100);  // the loop gives the old one back first
}

}  // namespace limpid
