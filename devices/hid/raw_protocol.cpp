#include "devices/hid/raw_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "devices/hid/hid_transport.h"

namespace limpid {

namespace {

constexpr Usage kApplication = make_usage(0xFF4C, 0x01);
constexpr std::uint8_t kMagic = 0x4C;
constexpr std::uint8_t kVersion = 1;

enum StatusBit : std::uint8_t {
  kHand = 1 << 1,
  kCalibrated = 1 << 2,
  kFault = 1 << 3,
  kCut = 1 << 4
};
enum Mode : std::uint8_t { kNoTorque = 0, kTorque = 1 };

// Places in a report, without its id.
enum At : std::size_t {
  kAtMagic = 0,
  kAtVersion = 1,
  kAtJoints = 2,
  kAtFlags = 3,
  kAtSequence = 4,
  kAtTimeStamp = 8,
  kAtValues = 16,
  kAtAnswered = 40,
  kAtCrc = 60,
};
enum FeatureAt : std::size_t {
  kAtRate = 4,
  kAtWatchdog = 6,
  kAtRanges = 8,
  kAtResolution = 32,
  kAtLimits = 36,
  kAtName = 48,
};

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

using Payload = std::span<const std::uint8_t>;

bool undamaged(Payload body) {
  return body[kAtMagic] == kMagic && body[kAtVersion] == kVersion &&
         load_le<std::uint32_t>(body, kAtCrc) == crc32(body.first(kAtCrc));
}

void check(bool good, const std::string& found, const char* allowed) {
  if (!good) throw HidError(fmt::format("the device says {}; {}", found, allowed));
}

std::string printable_name(Payload body) {
  std::string name;
  for (std::size_t i = kAtName; i < kAtCrc && body[i] != 0; ++i) {
    name += body[i] >= 0x20 && body[i] < 0x7F ? static_cast<char>(body[i]) : '?';
  }
  return name;
}

double milli(std::uint16_t value) { return 1e-3 * value; }
double milli_signed(std::uint16_t value) { return 1e-3 * static_cast<std::int16_t>(value); }

void read_joint(Payload body, std::size_t joint, DeviceTraits& traits) {
  const double lower = milli_signed(load_le<std::uint16_t>(body, kAtRanges + 4 * joint));
  const double upper = milli_signed(load_le<std::uint16_t>(body, kAtRanges + 4 * joint + 2));
  check(lower < upper, fmt::format("joint {} goes from {} to {} rad", joint + 1, lower, upper),
        "the lower end must be below the upper");
  traits.lower.push_back(lower);
  traits.upper.push_back(upper);
  if (!traits.pushes) return;
  const double effort = milli(load_le<std::uint16_t>(body, kAtLimits + 2 * joint));
  check(effort > 0, fmt::format("joint {} can push with 0 N m", joint + 1),
        "one with motors must have a torque limit above 0");
  traits.effort.push_back(effort);
}

DeviceTraits read_traits(Payload body) {
  DeviceTraits traits;
  traits.dof = body[kAtJoints];
  check(traits.dof >= 1 && traits.dof <= static_cast<int>(RawProtocol::kMaxJoints),
        fmt::format("it has {} joints", traits.dof), "1 to 6 are allowed");
  traits.pushes = body[kAtFlags] & 1;
  traits.rate = load_le<std::uint16_t>(body, kAtRate);
  const int watchdog = load_le<std::uint16_t>(body, kAtWatchdog);
  if (traits.pushes) {
    check(traits.rate >= 500 && traits.rate <= 8000, fmt::format("its rate is {} Hz", traits.rate),
          "one with motors must have 500 to 8000");
    check(watchdog >= 1 && watchdog <= 10, fmt::format("its watchdog takes {} ms", watchdog),
          "one with motors must have 1 to 10");
  }
  const float resolution = load_float_le(body, kAtResolution);
  check(std::isfinite(resolution) && resolution > 0,
        fmt::format("its resolution is {} rad", resolution), "it must be above 0");
  const auto joints = static_cast<std::size_t>(traits.dof);
  traits.resolution.assign(joints, resolution);
  for (std::size_t i = 0; i < joints; ++i) read_joint(body, i, traits);
  traits.name = printable_name(body);
  return traits;
}

}  // namespace

void seal_raw_report(std::span<std::uint8_t, RawProtocol::kReportSize> report) {
  const auto body = report.subspan(1);
  store_le(body, kAtCrc, crc32(body.first(kAtCrc)));
}

bool RawProtocol::describes(const ReportDescriptor& descriptor) {
  return std::find(descriptor.applications.begin(), descriptor.applications.end(), kApplication) !=
         descriptor.applications.end();
}

void RawProtocol::open(HidTransport& transport) {
  std::array<std::uint8_t, kReportSize> feature{};
  const int size = transport.get_feature(feature);
  if (size != static_cast<int>(kReportSize)) {
    throw HidError("the device does not answer when asked what it is (feature report)");
  }
  const Payload body = Payload(feature).subspan(1);
  if (!undamaged(body)) {
    throw HidError("the device's feature report has a wrong magic, version or CRC");
  }
  traits_ = read_traits(body);
  // Mode 0 is obeyed whatever its sequence is.
  const auto stop = command(kNoTorque, 0);
  stop_reports_ = {Report(stop.begin(), stop.end())};
}

Decoded RawProtocol::decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept {
  if (report.size() != kReportSize || report[0] != 0) return Decoded::unusable;
  const Payload body = report.subspan(1);
  if (!undamaged(body) || body[kAtJoints] != traits_.dof) return Decoded::unusable;

  // Drops repetitions: frozen firmware repeats itself, which must not pass for news.
  const auto sequence = load_le<std::uint32_t>(body, kAtSequence);
  if (reading_sequence_ && static_cast<std::int32_t>(sequence - *reading_sequence_) <= 0) {
    return Decoded::unusable;
  }
  const auto joints = static_cast<std::size_t>(traits_.dof);
  for (std::size_t i = 0; i < joints; ++i) {
    if (!std::isfinite(load_float_le(body, kAtValues + 4 * i))) return Decoded::unusable;
  }

  for (std::size_t i = 0; i < joints; ++i) {
    reading.x[i] = static_cast<double>(load_float_le(body, kAtValues + 4 * i));
  }
  const std::uint8_t status = body[kAtFlags];
  reading.hand = status & kHand;
  reading.fault = (status & kFault) || !(status & kCalibrated);
  // The device did not get the torques sent as long as this bit is set.
  if (status & kCut) ++reading.lapses;
  reading_sequence_ = sequence;
  time_stamp_ = load_le<std::uint64_t>(body, kAtTimeStamp);
  return Decoded::reading;
}

std::array<std::uint8_t, RawProtocol::kReportSize> RawProtocol::command(
    std::uint8_t mode, std::uint32_t sequence) const {
  std::array<std::uint8_t, kReportSize> report{};
  const auto body = std::span(report).subspan(1);
  body[kAtMagic] = kMagic;
  body[kAtVersion] = kVersion;
  body[kAtJoints] = static_cast<std::uint8_t>(traits_.dof);
  body[kAtFlags] = mode;
  store_le(body, kAtSequence, sequence);
  store_le(body, kAtTimeStamp, time_stamp_);
  store_le(body, kAtAnswered, reading_sequence_.value_or(0));
  seal_raw_report(report);
  return report;
}

void RawProtocol::encode(std::span<const double> torque, nanoseconds,
                         const SendReport& send) noexcept {
  if (!traits_.pushes) return;
  const bool any = std::any_of(torque.begin(), torque.end(), [](double t) { return t != 0; });
  auto report = command(any ? kTorque : kNoTorque, ++command_sequence_);
  const auto body = std::span(report).subspan(1);
  for (std::size_t i = 0; i < std::min(torque.size(), kMaxJoints); ++i) {
    store_float_le(body, kAtValues + 4 * i, static_cast<float>(torque[i]));
  }
  seal_raw_report(report);
  send(report);
}

}  // namespace limpid
