// A haptic device as the loop sees it: joint positions out, joint torques in.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// What it is; does not change while it is connected.
struct DeviceTraits {
  std::string name;                  // for people
  std::string id;                    // the same at every plug-in: vendor:product:serial
  int dof = 0;                       // joints
  bool pushes = false;               // has motors
  std::vector<double> lower, upper;  // range of each joint [rad]
  std::vector<double> resolution;    // of each joint [rad]
  std::vector<double> effort;        // torque limit of each joint [N m]; empty if it cannot push
  double rate = 0;                   // reports a second [Hz]
};

struct DeviceReading {
  std::array<double, kMaxDof> x{};  // joint positions [rad]
  std::uint64_t count = 0;          // readings so far
  double age = 0;                   // since it arrived [s]
  bool hand = true;                 // dead-man switch closed; true where there is none
  bool fault = false;               // the device says that it is not well
  std::uint32_t buttons = 0;        // one bit each
  std::uint32_t lapses = 0;  // how often its torque ran out, as nobody gave a new one in time
};

// Read, write and stop belong to the haptic thread: they never allocate, lock, throw, or wait.
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

}  // namespace limpid
