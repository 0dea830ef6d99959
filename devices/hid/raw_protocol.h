// Devices that speak the open raw-HID protocol, in little-endian reports (assets/paddle is one).
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

// Little-endian numbers in bytes, on any computer. The bytes at..at + sizeof(T) - 1 must exist.
template <std::unsigned_integral T>
T load_le(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) value = value << 8 | bytes[at + i];
  return static_cast<T>(value);
}

template <std::unsigned_integral T>
void store_le(std::span<std::uint8_t> bytes, std::size_t at, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
}

inline float load_float_le(std::span<const std::uint8_t> bytes, std::size_t at) {
  return std::bit_cast<float>(load_le<std::uint32_t>(bytes, at));
}

inline void store_float_le(std::span<std::uint8_t> bytes, std::size_t at, float value) {
  store_le(bytes, at, std::bit_cast<std::uint32_t>(value));
}

// Limpid's open protocol for haptic devices, version 1: write your firmware from this page.
//
// USB HID with vendor usage page 0xFF4C, usage 0x01. One 64-byte input report, one 64-byte output
// report, one 64-byte feature report, no report ids; for free use under 1209:4c50 or your own
// vendor and product number. Numbers are little-endian, f32 is IEEE 754. Bytes 60..63 of each
// report are the CRC-32 of bytes 0..59 (IEEE 802.3, as in zlib). Reserved bytes are sent as zero
// and not looked at. Up to 6 joints; arrays are always sent whole.
//
// Input, device to computer, at the rate that the feature report says:
//    0 u8      0x4C, 'L'
//    1 u8      version, 1
//    2 u8      joints, 1..6, as in the feature report
//    3 u8      bit 0: motors have power, bit 1: hand present (set it if you cannot tell),
//              bit 2: calibrated, bit 3: fault, bit 4: its watchdog has cut the torque
//    4 u32     sequence, goes up with every report (modulo 2^32)
//    8 u64     time stamp [us]
//   16 f32[6]  positions of the joints [rad]
//   40 u32     sequence of the newest command received
//   44         reserved
//
// Output, computer to device, about every millisecond:
//    0 u8      0x4C
//    1 u8      1
//    2 u8      joints
//    3 u8      0: no torque, 1: torque
//    4 u32     sequence, goes up with every command (modulo 2^32)
//    8 u64     newest time stamp seen [us]
//   16 f32[6]  torques [N m]
//   40 u32     sequence of the reading that it answers
//   44         reserved
//
// Feature, what the device is, read once:
//    0 u8      0x4C
//    1 u8      1
//    2 u8      joints
//    3 u8      bit 0: it has motors
//    4 u16     rate [Hz], 500..8000 if it has motors
//    6 u16     its watchdog [ms], 1..10 if it has motors
//    8 i16[6][2]  lower and upper end of each joint [1e-3 rad]
//   32 f32     resolution of the joints [rad]
//   36 u16[6]  torque limits [1e-3 N m]
//   48 char[12]  name, ASCII, padded with zeros
//
// Since a hand is on the device, firmware must
// - start with no torque, and limit torques itself;
// - use no command whose magic, version, joints or CRC is wrong, whose torque is not finite, or, in
//   mode 1, whose sequence did not go up;
// - obey mode 0 whatever its sequence is, and count on from that: a session begins with mode 0,
//   sequence 1 and ends with mode 0, sequence 0;
// - cut the torque when no usable command came for the watchdog's time, and say so in bit 4 until
//   the next one. Better still, it then uses none in mode 1 before one in mode 0 has come, as the
//   computer may not have heard of the cut.
// The computer does the same. It uses no reading that is damaged, not finite or whose sequence did
// not go up. After 5 ms without a usable one it sends mode 0; after one with bit 4 it sends mode 0,
// then torques that begin at zero.
class RawProtocol final : public HidProtocol {
 public:
  static constexpr std::size_t kReportSize = 1 + 64;  // with the id, which is 0
  static constexpr std::size_t kMaxJoints = 6;

  static bool describes(const ReportDescriptor& descriptor);

  // Reads the feature report; throws HidError naming what is wrong in it.
  void open(HidTransport& transport) override;

  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return std::chrono::milliseconds(5); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override;
  void encode(std::span<const double> torque, nanoseconds now,
              const SendReport& send) noexcept override;
  const std::vector<Report>& stop_reports() const override { return stop_reports_; }

 private:
  std::array<std::uint8_t, kReportSize> command(std::uint8_t mode, std::uint32_t sequence) const;

  DeviceTraits traits_;
  std::vector<Report> stop_reports_;
  std::optional<std::uint32_t> reading_sequence_;
  std::uint64_t time_stamp_ = 0;  // [us]
  std::uint32_t command_sequence_ = 0;
};

// Writes the CRC of a report, of all but its last four bytes, into these.
void seal_raw_report(std::span<std::uint8_t, RawProtocol::kReportSize> report);

}  // namespace limpid
