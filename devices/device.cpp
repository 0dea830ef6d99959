#include "devices/device.h"

#include <fmt/format.h>

#include "core/tick/motor_warmth.h"

namespace limpid {
namespace {

const char* explain(NoForce reason) {
  switch (reason) {
    case NoForce::none: return "";
    case NoForce::button: return "a button on the device has switched the force off";
    case NoForce::velocity: return "the device moved faster than its own speed limit";
    case NoForce::watchdog: return "the device's own watchdog has cut the force";
    case NoForce::software: return "the device's own software has switched the force off";
    case NoForce::connection: return "the device's connection was interrupted";
    case NoForce::dead_man: return "nobody holds the device's safety switch (dead-man switch)";
    case NoForce::warm: return "the device's motors are too warm";
    case NoForce::other: return "the device gives no reason";
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
    say(fmt::format("The device's hottest motor is at {:.0f} % of its thermal limit.",
                    100 * reading.warmth));
  }
  return words;
}

}  // namespace limpid
