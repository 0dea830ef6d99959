// Reports of a device that speaks the raw protocol, as its firmware would make them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/hid/raw_protocol.h"
#include "tests/support/fake_hid.h"

namespace limpid::test {

using RawReport = std::array<std::uint8_t, RawProtocol::kReportSize>;

// Opens it on a device that has this feature report.
inline void open_raw(RawProtocol& protocol, const Report& feature) {
  const auto device = std::make_shared<FakeHid>();
  device->features[0] = feature;
  FakeTransport transport(device);
  protocol.open(transport);
}

// Index in a report of byte `at` of the protocol's tables.
constexpr std::size_t byte(std::size_t at) { return 1 + at; }

inline Report sealed(RawReport report) {
  seal_raw_report(report);
  return {report.begin(), report.end()};
}

inline RawReport raw_header(std::uint8_t joints, std::uint8_t flags) {
  RawReport report{};
  report[byte(0)] = 0x4C;
  report[byte(1)] = 1;
  report[byte(2)] = joints;
  report[byte(3)] = flags;
  return report;
}

inline constexpr std::uint8_t kRawHand = 2, kRawCalibrated = 4, kRawFault = 8;

inline RawReport raw_reading(std::uint32_t sequence, const std::vector<float>& x,
                             std::uint8_t status = 1 | kRawHand | kRawCalibrated) {
  RawReport report = raw_header(static_cast<std::uint8_t>(x.size()), status);
  store_le(report, byte(4), sequence);
  store_le(report, byte(8), std::uint64_t{1000} * sequence);
  for (std::size_t i = 0; i < x.size(); ++i) store_float_le(report, byte(16 + 4 * i), x[i]);
  return report;
}

// A feature report: +-1 rad, 0.4 N m and more for each further joint, 1 kHz, watchdog 5 ms.
inline RawReport raw_feature(std::uint8_t joints, bool pushes = true) {
  RawReport report = raw_header(joints, pushes ? 1 : 0);
  store_le<std::uint16_t>(report, byte(4), 1000);
  store_le<std::uint16_t>(report, byte(6), 5);
  for (std::size_t i = 0; i < joints; ++i) {
    store_le(report, byte(8 + 4 * i), static_cast<std::uint16_t>(-1000));
    store_le<std::uint16_t>(report, byte(10 + 4 * i), 1000);
    store_le(report, byte(36 + 2 * i), static_cast<std::uint16_t>(400 + 100 * i));
  }
  store_float_le(report, byte(32), 1e-4f);
  report[byte(48)] = 'T';
  report[byte(49)] = '2';
  return report;
}

using Raw2Report = std::array<std::uint8_t, RawProtocol::kReading2Size>;
using Raw2Description = std::array<std::uint8_t, RawProtocol::kFeature2Size>;

template <std::size_t size>
Report sealed_2(std::array<std::uint8_t, size> report) {
  seal_raw_report(report);
  return {report.begin(), report.end()};
}

// A reading of version 2, of a device that is well.
inline Raw2Report raw_2_reading(std::uint32_t sequence, const std::vector<float>& x,
                                std::uint8_t status = 1 | kRawHand | kRawCalibrated) {
  Raw2Report report{};
  report[byte(0)] = 0x4C;
  report[byte(1)] = 2;
  report[byte(2)] = static_cast<std::uint8_t>(x.size());
  report[byte(3)] = status;
  store_le(report, byte(4), sequence);
  store_le(report, byte(8), std::uint64_t{1000} * sequence);
  for (std::size_t i = 0; i < x.size(); ++i) store_float_le(report, byte(16 + 4 * i), x[i]);
  return report;
}

struct Raw2Joint {
  bool slides = false;
  float end = 1, effort = 0, speed = 0;  // its range is from -end to end
};

// A feature report of version 2: 1 kHz, watchdog 5 ms, steps of 1e-4.
inline Raw2Description raw_2_feature(const std::vector<Raw2Joint>& joints, bool pushes = true) {
  Raw2Description report{};
  report[byte(0)] = 0x4C;
  report[byte(1)] = 2;
  report[byte(2)] = static_cast<std::uint8_t>(joints.size());
  report[byte(3)] = pushes ? 1 : 0;
  store_le<std::uint16_t>(report, byte(4), 1000);
  store_le<std::uint16_t>(report, byte(6), 5);
  for (std::size_t i = 0; i < joints.size() && i < 8; ++i) {
    report[byte(8 + i)] = joints[i].slides ? 1 : 0;
    store_float_le(report, byte(16 + 4 * i), -joints[i].end);
    store_float_le(report, byte(48 + 4 * i), joints[i].end);
    store_float_le(report, byte(80 + 4 * i), 1e-4f);
    store_float_le(report, byte(112 + 4 * i), joints[i].effort);
    store_float_le(report, byte(144 + 4 * i), joints[i].speed);
  }
  report[byte(176)] = 'V';
  report[byte(177)] = '2';
  report[byte(224)] = 'f';
  return report;
}

struct RawCommand {
  bool right = true;  // size, magic, version, CRC
  std::uint8_t mode = 0;
  std::uint32_t sequence = 0;
  std::uint32_t answered = 0;
  std::array<float, 6> torque{};

  bool pushes() const {
    for (const float one : torque) {
      if (mode != 0 && one != 0) return true;
    }
    return false;
  }
};

inline RawCommand raw_command(const Report& report) {
  RawCommand command;
  if (report.size() != RawProtocol::kReportSize) return {.right = false};
  RawReport again{};
  std::copy(report.begin(), report.end(), again.begin());
  command.right = report == sealed(again) && report[byte(0)] == 0x4C && report[byte(1)] == 1;
  command.mode = report[byte(3)];
  command.sequence = load_le<std::uint32_t>(report, byte(4));
  command.answered = load_le<std::uint32_t>(report, byte(40));
  for (std::size_t i = 0; i < 6; ++i) command.torque[i] = load_float_le(report, byte(16 + 4 * i));
  return command;
}

}  // namespace limpid::test
