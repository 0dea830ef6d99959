#include "devices/vendor/servo.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/realtime/clock.h"

namespace limpid {
namespace {

constexpr nanoseconds kPeriod = std::chrono::microseconds(500);  // of frames in a thread of ours

bool finite(const TipVector& x) {
  return std::ranges::all_of(x, [](double each) { return std::isfinite(each); });
}

}  // namespace

nanoseconds monotonic_now() noexcept { return MonotonicTime{}.now(); }

bool Servo::frame(VendorBackEnd& device) noexcept {
  if (ended_) return false;
  const bool last = ending_;
  try {
    VendorReading reading = last_;
    device.read(reading);
    if (!finite(reading.x)) {
      reading.x = last_.x;
      reading.fault = true;
    }
    last_ = reading;
    last_.fault = false;
    const nanoseconds now = monotonic_now();
    device.write(last ? VendorForce{} : force_now(reading, now));
    frames_.write({reading, now, cut_});
    last_frame_ = now.count();
  } catch (const std::exception& error) {
    try {
      device.write({});
    } catch (const std::exception&) {  // the first error is the one to tell
    }
    fail(error.what());
  }
  if (last) ended_ = true;
  tell();
  return !ended_;
}

void Servo::fail(const std::string& error) noexcept {
  if (ended_) return;
  error_ = error;
  ended_ = true;
  tell();
}

void Servo::tell() const noexcept {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t told = ::write(news_, &one, sizeof one);
}

VendorForce Servo::force_now(const VendorReading& reading, nanoseconds now) noexcept {
  commands_.update();
  const Command& command = commands_.front();
  // Silence cuts, whether or not the command had a force: the computer has to hear of it.
  // A pause of the library does so, too: the motors may have held an old force meanwhile.
  const bool paused = now - last_frame() > kForceLife;
  if (paused || now - command.moment > kForceLife || reading.fault || !reading.calibrated ||
      reading.no_force == NoForce::watchdog) {
    cut_ = true;
  }
  if (cut_) {
    enabled_ = false;
    return {};
  }
  // The motors stay on in free motion, when there is no force.
  enabled_ = enabled_ || command.pushes;
  VendorForce force{{}, enabled_};
  if (!command.pushes || !reading.hand) return force;
  for (std::size_t i = 0; i < force.force.size(); ++i) {
    force.force[i] = std::clamp(command.force[i], -most_, most_);
  }
  return force;
}

void Servo::command(const TipVector& force, bool pushes) noexcept {
  commands_.write({force, pushes, monotonic_now()});
  if (!pushes) cut_ = false;
}

bool Servo::take(Frame& newest) noexcept {
  if (!frames_.update()) return false;
  newest = frames_.front();
  return true;
}

void VendorBackEnd::begin(Servo& servo) {
  thread_ = std::thread([this, &servo] {
    const MonotonicTime clock;
    nanoseconds due = clock.now();
    while (servo.frame(*this)) {
      due = std::max(due + kPeriod, clock.now());
      clock.sleep_until(due);
    }
  });
}

void VendorBackEnd::end() noexcept {
  if (thread_.joinable()) thread_.join();
}

}  // namespace limpid
