#include "app/desktop/device/device_controller.h"

#include <fmt/format.h>

#include <algorithm>

namespace limpid {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLook{1000};      // between two looks for plugged devices
constexpr milliseconds kServices{5000};  // between two questions to programs that serve devices
constexpr milliseconds kRetry{3000};     // between two attempts to open a device
constexpr milliseconds kSettle{500};     // until the loop shows whether a new device answers

}  // namespace

void DeviceController::update() {
  look();
  take_connected();
  follow_check();
  if (live_.loop().device_in_place()) live_.controls().limits = hub_.notes(hub_.in_use()).limits;
  if (live_.loop().device_plugged()) return watch();
  if (hub_.in_use().empty() || lent_ || connecting_.valid() || check_.valid() ||
      live_.loop().holds_device() || Clock::now() < retry_at_) {
    return;
  }
  decide_who_chooses();
  if (!hub_.refusal().empty()) {  // until the file is mended
    hub_.read_again();
    retry_at_ = Clock::now() + kRetry;
  }
  if (std::string why = obstacle(); !why.empty()) {
    problem_ = std::move(why);
    blocked_ = true;
    return;
  }
  if (std::exchange(blocked_, false)) problem_.clear();
  if (!awaits_check()) return connect();
  if (problem_.empty())
    problem_ = "The device's axes must be checked before the device may give force.";
}

std::string DeviceController::obstacle() const {
  const FoundDevice* found = hub_.present();
  if (found == nullptr) return "not connected";
  if (!found->missing.empty()) return found->missing;
  if (std::string refusal = hub_.refusal(); !refusal.empty()) return refusal;
  std::string why = waits_;
  if (!found->in_use_by.empty()) {
    why += fmt::format("{}The device is in use by {}.", why.empty() ? "" : " ", found->in_use_by);
  }
  if (!why.empty()) return why;
  return must_wait() ? "the device waits for the end of the recording" : "";
}

void DeviceController::decide_who_chooses() {
  if (std::exchange(decided_, true) || !waits_.empty()) return;
  if (const std::string other = hub_.go_first(); !other.empty()) {
    wait_for_choice(
        fmt::format("Another window of Limpid already uses a device ({}). Therefore this window "
                    "does not connect to a device by itself.",
                    other));
  }
}

// Lets the user's choice stand. Another window that is the first stays so.
void DeviceController::choose() {
  decided_ = true;
  waits_.clear();
  retry_at_ = {};
  hub_.go_first();
}

bool DeviceController::waits_for_choice() const {
  const FoundDevice* found = hub_.present();
  return !waits_.empty() && found != nullptr && found->missing.empty();
}

bool DeviceController::awaits_check() const {
  const bool unchecked = hub_.needs_check() || unchecked_ == hub_.in_use();
  return unchecked && !hub_.in_use().empty() && !check_.valid() && hub_.refusal().empty();
}

bool DeviceController::must_wait() const {
  const FoundDevice* found = hub_.present();
  return live_.recording() && !live_.loop().device_in_place() && found != nullptr &&
         !found->kind->leads_hand;
}

void DeviceController::look() {
  if (auto found = take_ready(looking_)) {
    hub_.take(std::move(*found), asking_services_);
    say_what_came();
  }
  const auto now = Clock::now();
  if (looking_.valid() || now < look_at_) return;
  asking_services_ = now >= services_at_;
  if (asking_services_) services_at_ = now + kServices;
  looking_ = live_.device_tasks().run([wanted = hub_.in_use(), services = asking_services_] {
    return DeviceHub::look(wanted, services);
  });
  look_at_ = now + kLook;
}

// Shows a notice on new devices: not on those of the start, which are in menu and panel, nor on the
// device in use.
void DeviceController::say_what_came() {
  std::vector<std::string> here;
  for (const FoundDevice& found : hub_.found()) {
    here.push_back(found.place.id);
    if (!known_ || std::ranges::find(*known_, found.place.id) != known_->end()) continue;
    if (found.place.id == hub_.in_use()) continue;
    notices_.say(fmt::format("{} is plugged in. To use it, choose it in the menu Device.",
                             found.place.name));
  }
  known_ = std::move(here);
}

void DeviceController::watch() {
  const Snapshot& snapshot = live_.loop().snapshot();
  if (Clock::now() < plugged_at_ + kSettle) return;
  const std::uint64_t trips = live_.loop().trips();
  if (std::exchange(trips_said_, trips) != trips && snapshot.arming == Arming::tripped) {
    const std::string words = device_words(snapshot.reading);
    notices_.say(
        fmt::format("Force is off: {}.{}{} After a second, key F switches the force on again.",
                    explain(snapshot.force_state), words.empty() ? "" : " ", words),
        true);
  }
  if (!snapshot.connected) {
    problem_ = "not connected";
    notices_.say(
        "The device is disconnected. If you plug the device in again, Limpid uses it again, at "
        "first without force.",
        true);
    live_.loop().plug(nullptr);
    return;
  }
  const std::uint32_t pressed = buttons_.take(snapshot.reading);
  if ((pressed & 1) != 0) requests_.first_button();
  if ((pressed & 2) != 0) requests_.second_button();
}

// Without an id nothing under way is wanted, even if no device is chosen.
bool DeviceController::still_wanted() const {
  return !connecting_id_.empty() && connecting_id_ == hub_.in_use();
}

void DeviceController::connect() {
  problem_ = "connecting";
  connecting_id_ = hub_.in_use();
  connecting_ = live_.device_tasks().run(hub_.opening());
}

void DeviceController::take_connected() {
  try {
    auto ready = take_ready(connecting_);
    if (!ready) return;
    if (!still_wanted() || must_wait()) {
      return live_.let_go(std::move(*ready));
    }
    const DeviceTraits traits = (*ready)->traits();
    if (hub_.note_said_arm(traits)) save();
    requests_.open(std::move(*ready));
    problem_.clear();
    notices_.say(traits.pushes
                     ? fmt::format("{} is now part of the control loop{}. Take the device in your "
                                   "hand, then press F to arm the force.",
                                   traits.name,
                                   traits.made_by.empty() ? "" : ", driven by " + traits.made_by)
                     : fmt::format("{} moves the hand.", traits.name));
  } catch (const UncheckedError&) {
    unchecked_ = connecting_id_;
    problem_.clear();
  } catch (const std::exception& e) {
    problem_ = e.what();
    retry_at_ = Clock::now() + kRetry;
  }
}

void DeviceController::save() {
  if (const std::string error = hub_.save(); !error.empty()) notices_.say(error, true);
}

void DeviceController::plugged() {
  buttons_.forget();
  trips_said_ = live_.loop().trips();
  plugged_at_ = Clock::now();
}

void DeviceController::start_check() {
  choose();
  progress_ = std::make_shared<AxisCheckProgress>();
  problem_.clear();
  check_failed_ = false;
  connecting_id_ = hub_.in_use();
  const auto run = [check = hub_.checking(progress_), progress = progress_,
                    warmth = live_.loop().warmth_memory()] {
    AxisCheck done = check();
    warmth->add(progress->warmth, in_seconds(MonotonicTime{}.now()));
    return done;
  };
  check_ = live_.device_tasks().run(run);
}

void DeviceController::follow_check() {
  if (!check_.valid()) return;
  progress_->see_window();
  try {
    const auto check = take_ready(check_);
    if (!check || !still_wanted()) return;
    problem_ = report_of(*check, progress_->end);
    check_failed_ = !check->passed();
    if (!remember_check(*check, hub_.notes(hub_.in_use()))) {
      return notices_.say(
          "The device's axes did not pass the check. Limpid does not use the device.", true);
    }
    notices_.say("The device's axes move in the direction in which the motors push.\n" + problem_);
    problem_.clear();
    unchecked_.clear();
    save();
  } catch (const std::exception& e) {
    problem_ = e.what();
    retry_at_ = Clock::now() + kRetry;
  }
}

void DeviceController::use(const std::string& id) {
  if (live_.recording()) {
    notices_.say("Stop the recording before you change the device.", true);
    return;
  }
  if (id == hub_.in_use()) return take_turn(id);
  if (live_.loop().device_in_place()) live_.loop().cut();
  requests_.close([this, id] {
    take_turn(id);
    hub_.use(id);
    cancel_check();
    problem_.clear();
    check_failed_ = false;
    unchecked_.clear();
    retry_at_ = services_at_ = {};
    save();
  });
}

// Takes or gives up this window's turn to connect to devices by itself.
void DeviceController::take_turn(const std::string& id) {
  if (id.empty()) return hub_.give_way();
  choose();
}

// Drops a connection under way, too: it knows the device as it was.
void DeviceController::connect_anew() {
  save();
  connecting_id_.clear();
  if (live_.loop().device_plugged()) lend();
  take_back();
}

void DeviceController::say_arm(const NamedArm& arm) {
  if (live_.recording()) {
    return notices_.say("Stop the recording before you choose the device's arm.", true);
  }
  cancel_check();
  hub_.say_arm(arm.file, arm.tip, nullptr);
  problem_.clear();
  retry_at_ = {};
  connect_anew();
}

void DeviceController::lend() {
  lent_ = true;
  live_.loop().cut();
  cancel_check();
  live_.loop().plug(nullptr);
}

}  // namespace limpid
