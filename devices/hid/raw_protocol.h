// Devices that speak the open raw-HID protocol, in little-endian reports (assets/paddle is one).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/raw_reports.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

// Limpid's open protocol for haptic devices: write your firmware from this page. Version 1 has up
// to 6 joints that turn, all with motors or none. Version 2 has up to 8 joints that turn or slide,
// with a motor or without, buttons, and the reason why there is no force. A device speaks one of
// them.
//
// USB HID with vendor usage page 0xFF4C, usage 0x01. One input report, one output report, one
// feature report, no report ids; for free use under 1209:4c50 or your own vendor and product
// number. Numbers are little-endian, f32 is IEEE 754. The last 4 bytes of each report are the
// CRC-32 of all bytes before them (IEEE 802.3, as in zlib). Reserved bytes are sent as zero and not
// looked at. Arrays are always sent whole; what is behind the device's own joints is sent as zero.
// A program on a socket (transports.h) sends the same reports, each as a packet.
//
// Version 1: three reports of 64 bytes.
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
// Feature, the description of the device, read once:
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
// Version 2: an input report of 128 bytes, an output report of 64, a feature report of 256. Where
// it says "or", the second unit is that of a joint that slides.
//
// Input:
//    0 u8      0x4C
//    1 u8      version, 2
//    2 u8      joints, 1..8, as in the feature report
//    3 u8      as in version 1
//    4 u32     sequence
//    8 u64     time stamp [us]; the speed of the joints is judged by it
//   16 f32[8]  positions of the joints [rad or m]
//   48 u32     sequence of the newest command received
//   52 u32     buttons, one bit each, 1: pressed. The first one switches coupling or magnet, the
//              second one asks for force and cuts it
//   56 u8      why the motors do not give what they are told: 0 they do, 1 a button of the device,
//              2 too fast, 3 its watchdog, 4 its software, 5 its connection, 6 nobody holds it,
//              7 its motors are warm, 8 another reason
//   57         reserved
//   60 f32     warmth of the hottest motor, 0 cold to 1 as warm as it may be; 0 if not known
//   64 f32[4]  orientation of the tool as a quaternion, w x y z; all zero if not known or if the
//              joints have it already. The tool's axes are x along it towards what it touches, y
//              to its left, z up; at 1 0 0 0 they are those of the arm's base: it points forward.
//              One whose length is off 1 by more than a hundredth counts as not known
//   80 f32[8]  measured torques or forces at the joints [N m or N]; zero if there is no sensor
//  112         reserved
//
// Output:
//    0..15     as in version 1, the version being 2
//   16 f32[8]  torques or forces [N m or N]
//   48 u32     sequence of the reading that it answers
//   52         reserved
//
// Feature:
//    0..7      as in version 1, the version being 2
//    8 u8[8]   kind of each joint: 0 turns, 1 slides
//   16 f32[8]  lower end of each joint [rad or m]
//   48 f32[8]  upper end [rad or m]
//   80 f32[8]  resolution [rad or m]
//  112 f32[8]  largest torque or force [N m or N]; 0: this joint has no motor
//  144 f32[8]  largest speed of which the joint is capable [rad/s or m/s]; 0: not said
//  176 char[48]  name, ASCII, padded with zeros
//  224 char[28]  what speaks for the device, as firmware or library with its version; ASCII
//
// The computer asks a HID device for 64 bytes of the feature report first, and for 256 if these say
// version 2, or nothing.
//
// Declarations of a device of version 2 are checked. A reading that is outside of a joint's range
// by more than a tenth of it, or farther from the reading before than the joint's speed allows, is
// taken for a fault, and the force is off until somebody arms it again.
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
// not go up. After 5 ms without a usable one it sends mode 0; after one with bit 4, or with a
// reason why there is no force, it sends mode 0, then torques that begin at zero.
//
// Limpid does not use measured forces yet; RawProtocol::extras() has them.
class RawProtocol final : public HidProtocol {
 public:
  static constexpr std::size_t kReportSize = 1 + kRaw1.command;    // with the id, which is 0
  static constexpr std::size_t kReading2Size = 1 + kRaw2.reading;  // likewise
  static constexpr std::size_t kFeature2Size = 1 + kRaw2.feature;  // likewise

  // Numbers that a device of version 2 sends, and that nothing uses yet.
  struct Extras {
    std::array<float, kRaw2.joints> measured{};  // at the joints [N m or N]
  };

  static bool describes(const ReportDescriptor& descriptor);

  // Reads the feature report; throws HidError naming what is wrong in it.
  void open(HidTransport& transport) override;

  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return std::chrono::milliseconds(5); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override;
  void encode(std::span<const double> torque, nanoseconds now,
              const SendReport& send) noexcept override;
  const std::vector<Report>& stop_reports() const override { return stop_reports_; }

  const Extras& extras() const { return extras_; }

 private:
  using Command = std::array<std::uint8_t, kReportSize>;
  using Positions = std::array<double, kRaw2.joints>;

  Command command(RawMode mode, std::uint32_t sequence) const;
  double unit(std::size_t joint) const;
  bool is_where_it_can_be(const Positions& x, double dt) const;
  Decoded take_more(std::span<const std::uint8_t> body, const Positions& x, std::uint32_t sequence,
                    DeviceReading& reading) noexcept;

  RawLayout layout_ = kRaw1;
  DeviceTraits traits_;
  std::array<double, kRaw2.joints> speed_{};  // largest of each joint [rad/s or m/s]; 0: not said
  Extras extras_;
  std::optional<Positions> believed_;  // newest positions that can be [rad or m]
  std::uint32_t believed_sequence_ = 0;
  std::uint64_t believed_at_ = 0;  // [us]
  std::vector<Report> stop_reports_;
  std::optional<std::uint32_t> reading_sequence_;
  std::uint64_t time_stamp_ = 0;  // [us]
  std::uint32_t command_sequence_ = 0;
};

// Writes the check sum of a report, which begins with its id, into its last four bytes.
inline void seal_raw_report(std::span<std::uint8_t> report) { seal_raw_bytes(report.subspan(1)); }

}  // namespace limpid
