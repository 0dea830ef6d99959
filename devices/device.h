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

// The hand that holds a simulated device, over a tick: it goes on from where it wanted the tip a
// tick ago to `target`.
struct HandInput {
  Vec3 target = Vec3::Zero();        // [m]
  double grip = 1;                   // 1 holds, 0 has let go; scales stiffness and damping
  std::span<const double> torque{};  // pushed on the joints besides [N m]; empty: none
  bool magnet = false;               // picks up what it may
  BodyPull pull{};                   // what somebody pulls on besides, with no arm
};

// What it is; does not change while it is connected.
struct DeviceTraits {
  std::string name;     // for people
  std::string id;       // the same at every plug-in: vendor:product:serial
  int dof = 0;          // joints
  bool pushes = false;  // has motors
  bool guarded = true;  // a hand is on it: its force is armed first, and the safety limits hold
  std::vector<double> lower, upper;  // range of each joint [rad]
  std::vector<double> resolution;    // of each joint [rad]
  std::vector<double> effort;        // torque limit of each joint [N m]; empty if it cannot push
  double rate = 0;                   // reports a second [Hz]
};

// The step of its coarsest encoder, as far as device.encoder_step goes; 0: it tells of none [rad].
inline double encoder_step_of(const DeviceTraits& traits) {
  double step = 0;
  for (const double each : traits.resolution) step = std::max(step, each);
  return std::min(step, kMostEncoderStep);
}

struct DeviceReading {
  std::array<double, kMaxDof> x{};  // joint positions [rad]
  std::uint64_t count = 0;          // readings so far
  double age = 0;                   // since it arrived [s]
  bool hand = true;                 // dead-man switch closed; true where there is none
  bool fault = false;               // the device says that it is not well
  std::uint32_t buttons = 0;        // one bit each
  std::uint32_t lapses = 0;  // how often its torque ran out, as nobody gave a new one in time
};

// What only a simulated device knows of itself.
struct DeviceTruth {
  std::span<const double> x, v;          // where it is, not rounded by encoders [rad, rad/s]
  std::span<const double> hand_torque;   // f1, the mean over the last tick [N m]
  std::span<const double> motor_torque;  // that acted over it [N m]
};

// All but traits() belongs to the haptic thread: it never allocates, locks, throws, or waits.
class Device {
 public:
  virtual ~Device() = default;
  virtual const DeviceTraits& traits() const = 0;
  // The newest reading; false if the device is lost.
  virtual bool read(DeviceReading& newest) noexcept = 0;
  // The torque to be held until the next one [N m], one a joint.
  virtual void write(std::span<const double> torque) noexcept = 0;
  // No torque, now.
  virtual void stop() noexcept = 0;

  // What a simulated device is told and asked besides. Before a reading: what the tick is like.
  virtual void expect(const Parameters&, const HandInput&) noexcept {}
  // Where it begins, the hand's target on the tip [rad, rad/s, m].
  virtual void place(std::span<const double>, std::span<const double>, const Vec3&) noexcept {}
  virtual std::optional<DeviceTruth> truth() const noexcept { return std::nullopt; }
};

// Before the haptic thread has the device: waits until it has said where it is; false if it has not
// within that time.
inline bool await_reading(Device& device, std::chrono::milliseconds longest) {
  DeviceReading reading;
  const auto end = std::chrono::steady_clock::now() + longest;
  while (device.read(reading) && reading.count == 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return reading.count > 0;
}

// What a device's buttons ask for.

// A button counts when it goes down after it was seen up: one that is held while the device is
// plugged in asks for nothing.
class ButtonPresses {
 public:
  void forget() { down_ = ~0u; }

  // Those that went down since the last call; one bit each, as in DeviceReading.
  std::uint32_t take(std::uint32_t now) {
    const std::uint32_t pressed = now & ~down_;
    down_ = now;
    return pressed;
  }

 private:
  std::uint32_t down_ = ~0u;
};

// What a reading says of a device's health, for whoever judges whether its motors may push.

// `here`: read() said that the device is there. `dt`: since the reading before [s]. `silence`:
// since its watcher last answered [s]. `lapses`: how many of the device's are known of; none: all
// are news.
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
