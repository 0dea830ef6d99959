// The device's end of the raw protocol, version 2 (raw_protocol.h), for programs that play a
// device.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/device.h"
#include "devices/hid/raw_reports.h"

namespace limpid {

// First byte of the packet that a connection gets in place of a description; words say why.
inline constexpr char kRefusal = '!';

struct RawJoint {
  bool slides = false;
  double lower = 0, upper = 0, resolution = 0;  // [rad or m]
  double effort = 0;                            // [N m or N]; 0: no motor
  double speed = 0;                             // [rad/s or m/s]; 0: not said
};

struct RawDescription {
  std::string name, made_by;
  bool pushes = false;
  std::uint16_t rate = 1000;   // [Hz]
  std::uint16_t watchdog = 5;  // [ms]
  std::vector<RawJoint> joints;
};

// The state of a device, as a reading tells it.
struct RawState {
  std::uint32_t sequence = 0, answered = 0;
  std::uint64_t time_stamp = 0;          // [us]
  std::uint8_t flags = 0;                // RawFlag
  std::array<double, kRaw2.joints> x{};  // [rad or m]
  std::uint32_t buttons = 0;
  NoForce no_force = NoForce::none;
  float warmth = 0;
  std::array<float, 4> orientation{};  // w x y z; all zero: not known
};

// A command that firmware may obey.
struct RawOrder {
  RawMode mode = RawMode::no_torque;
  std::uint32_t sequence = 0;
  std::array<double, kRaw2.joints> torque{};  // [N m or N]
};

// Packets without an id, sealed.
std::array<std::uint8_t, kRaw2.feature> raw_feature(const RawDescription& description);
std::array<std::uint8_t, kRaw2.reading> raw_reading(const RawState& state, std::size_t joints);

// Reads a command by the rules for firmware; nothing if it is not to be obeyed. `last`: sequence of
// the newest command that was.
std::optional<RawOrder> raw_order(std::span<const std::uint8_t> packet, std::size_t joints,
                                  std::uint32_t last);

}  // namespace limpid
