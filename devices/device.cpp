#include "devices/device.h"

#include <fmt/format.h>

#include "core/tick/motor_warmth.h"

namespace limpid {
namespace {

const char* explain(NoForce reason) {
  switch (reason) {
    case NoForce::none: return "";
    case NoForce::button: return "its force is switched off by a button of its own";
    case NoForce::velocity: return "it moved faster than it allows itself";
    case NoForce::watchdog: return "its own watchdog has cut the force";
    case NoForce::software: return "the device's own software has switched its force off";
    case NoForce::connection: return "its connection was interrupted";
    case NoForce::dead_man: return "nobody holds its dead-man switch";
    case NoForce::warm: return "its motors are too warm";
    case NoForce::other: return "it does not say why";
  }
  return "";
}

}  // namespace

std::string device_text(const DeviceTraits& traits) {
  return fmt::format("{}, {}{}", traits.name, traits.id,
                     traits.made_by.empty() ? "" : ", by " + traits.made_by);
}

std::string device_words(const DeviceReading& reading) {
  std::string words;
  const auto say = [&](const std::string& sentence) {
    words += (words.empty() ? "" : " ") + sentence;
  };
  if (!reading.calibrated) say("The device is not calibrated.");
  if (reading.no_force != NoForce::none) {
    say(fmt::format("The device itself gives no force: {}.", explain(reading.no_force)));
  }
  if (static_cast<double>(reading.warmth) >= kWarmFrom) {
    say(fmt::format("Its hottest motor is at {:.0f} % of its thermal limit.",
                    100 * reading.warmth));
  }
  return words;
}

}  // namespace limpid
