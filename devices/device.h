// A haptic device as the loop sees it: joint positions out, joint torques in.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/math/sizes.h"
#include "core/tick/parameters.h"
#include "core/tick/safety.h"
#include "core/touch/body.h"

namespace limpid {

// The hand that holds a simulated device, over one tick. Where it wants the tip moves from the last
// tick's target to `target`.
struct HandInput {
  Vec3 target = Vec3::Zero();        // [m]
  double grip = 1;                   // 1 holds, 0 has let go; scales stiffness and damping
  std::span<const double> torque{};  // torque pushed on the joints besides [N m]; empty: none
  bool magnet = false;               // picks up bodies that may be picked up
  BodyPull pull{};                   // pull on a body besides, without an arm
};

// Properties of a device that do not change while it is connected.
struct DeviceTraits {
  std::string name;     // for people
  std::string id;       // the same at every plug-in: vendor:product:serial
  int dof = 0;          // joints
  bool pushes = false;  // has motors
  bool guarded = true;  // a hand is on it: its force is armed first, and the safety limits hold
  std::vector<double> lower, upper;  // range of each joint [rad]
  std::vector<double> resolution;    // step of each joint's encoder [rad]
  std::vector<double> effort;        // torque limit of each joint [N m]; empty if it cannot push
  double rate = 0;                   // reports a second [Hz]
  std::vector<bool> slides = {};     // joints that slide; empty: the device does not say it
  std::string made_by = {};          // what speaks for it, as firmware or library with its version
};

// Name, id and maker's library of a device, for people and recordings.
std::string device_text(const DeviceTraits& traits);

// The step of the device's coarsest encoder, at most device.encoder_step's; 0 if it names none
// [rad].
inline double encoder_step_of(const DeviceTraits& traits) {
  double step = 0;
  for (const double each : traits.resolution) step = std::max(step, each);
  return std::min(step, kMostEncoderStep);
}

// Reason that a device gives for having no force of its own accord; numbers as in the raw protocol.
enum class NoForce : std::uint8_t {
  none,  // it has force
  button,
  velocity,
  watchdog,
  software,
  connection,
  dead_man,
  warm,
  other,
};
inline constexpr int kNoForces = 9;

struct DeviceReading {
  std::array<double, kMaxDof> x{};   // joint positions [rad]
  std::uint64_t count = 0;           // readings so far
  double age = 0;                    // time since it arrived [s]
  bool hand = true;                  // dead-man switch closed; true where there is none
  bool fault = false;                // the device says that it is not well
  std::uint32_t buttons = 0;         // pressed ones, one bit each
  std::uint32_t buttons_known = 0;   // those that a report has told of, one bit each
  std::uint32_t lapses = 0;          // how often the torque ran out, as no new one came in time
  NoForce no_force = NoForce::none;  // why the device itself has no force
  bool calibrated = true;            // a fault besides, if not
  float warmth = 0;                  // of its hottest motor: 0 cold, 1 as warm as it may be [-]
  // Orientation of the tool as a quaternion w, x, y, z of unit length; all zero: not known. The
  // tool's axes are x along it towards what it touches, y to its left, z up; they are those of the
  // arm's base at 1 0 0 0.
  std::array<double, 4> orientation{};

  bool oriented() const {
    return std::ranges::any_of(orientation, [](double part) { return part != 0; });
  }
};

// Sentences of the device about itself, for people, beyond what force_text() says; empty: none.
std::string device_words(const DeviceReading& reading);

// True state of a simulated device.
struct DeviceTruth {
  std::span<const double> x, v;  // positions, not rounded by encoders, and velocities [rad, rad/s]
  std::span<const double> hand_torque;   // f1, the mean over the last tick [N m]
  std::span<const double> motor_torque;  // the torque that acted over the last tick [N m]
};

// A haptic device. All but traits() belongs to the haptic thread, and never allocates, locks,
// throws or waits.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceTraits& traits() const = 0;
  // Gives the newest reading; false if the device is lost.
  virtual bool read(DeviceReading& newest) noexcept = 0;
  // Sets the torque that is held until the next one [N m], one a joint.
  virtual void write(std::span<const double> torque) noexcept = 0;
  // Sets zero torque at once.
  virtual void stop() noexcept = 0;

  // Tells a simulated device the tick's parameters and hand, before its reading.
  virtual void expect(const Parameters&, const HandInput&) noexcept {}
  // Puts a simulated device somewhere, the hand's target on the tip [rad, rad/s, m].
  virtual void place(std::span<const double>, std::span<const double>, const Vec3&) noexcept {}
  virtual std::optional<DeviceTruth> truth() const noexcept { return std::nullopt; }
};

// Waits for a device's first reading, before the haptic thread has the device. False if none came
// in time.
inline bool await_reading(Device& device, std::chrono::milliseconds longest) {
  DeviceReading reading;
  const auto end = std::chrono::steady_clock::now() + longest;
  while (device.read(reading) && reading.count == 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return reading.count > 0;
}

// Buttons that went down after they were seen up. A button that is held while its device is plugged
// in asks for nothing, however late the device's first report comes.
class ButtonPresses {
 public:
  void forget() { down_ = ~0u; }

  // Takes the buttons pressed since the last call; one bit each, as in DeviceReading.
  std::uint32_t take(const DeviceReading& reading) {
    const std::uint32_t pressed = reading.buttons & reading.buttons_known & ~down_;
    down_ = reading.buttons | ~reading.buttons_known;
    return pressed;
  }

 private:
  std::uint32_t down_ = ~0u;
};

// The health of a device by its reading, from which follows whether its motors may push. `here`:
// read() said that the device is there. `dt`: time since the reading before [s]. `silence`: time
// since the device's watcher last answered [s]. `lapses`: those known so far; nothing: those of
// this reading are new.
inline DeviceHealth health_of(const DeviceReading& reading, bool here, bool guarded, double dt,
                              double silence, std::optional<std::uint32_t>& lapses) {
  DeviceHealth health{.guarded = guarded,
                      .hand = reading.hand,
                      .fault = reading.fault,
                      .lost = !here,
                      .age = reading.age,
                      .gap = dt > SafetyLimits::kGap || (here && lapses != reading.lapses),
                      .silence = silence};
  if (reading.count == 0) health.age = SafetyLimits::kStaleReading * 2;
  if (here) lapses = reading.lapses;
  return health;
}

}  // namespace limpid
