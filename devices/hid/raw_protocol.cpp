#include "devices/hid/raw_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/dynamics/arm_description.h"
#include "devices/hid/hid_transport.h"

namespace limpid {

namespace {

constexpr Usage kApplication = make_usage(0xFF4C, 0x01);

// Ends of a joint of version 2 must be within these.
constexpr double kFarthestTurn = 100;  // [rad]
constexpr double kFarthestSlide = 10;  // [m]
constexpr double kLengthOff = 0.01;    // of a quaternion that still is an orientation
constexpr double kBeyond = 0.1;        // part of its range that a joint may be outside of it

using Payload = std::span<const std::uint8_t>;

void check(bool good, const std::string& found, const char* allowed) {
  if (!good) {
    throw HidError(fmt::format("the device's description is wrong: {}; {}", found, allowed));
  }
}

std::string printable(Payload bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size() && bytes[i] != 0; ++i) {
    text += bytes[i] >= 0x20 && bytes[i] < 0x7F ? static_cast<char>(bytes[i]) : '?';
  }
  return text;
}

double milli(std::uint16_t value) { return 1e-3 * value; }
double milli_signed(std::uint16_t value) { return 1e-3 * static_cast<std::int16_t>(value); }

double number_at(Payload body, std::size_t at, std::size_t joint) {
  return static_cast<double>(load_float_le(body, at + 4 * joint));
}

// The orientation of the tool in a reading; all zero where it is none.
std::array<double, 4> orientation_in(Payload body) {
  std::array<double, 4> parts{};
  double square = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i] = number_at(body, Raw2Reading::orientation, i);
    square += parts[i] * parts[i];
  }
  const double length = std::sqrt(square);
  if (!(std::abs(length - 1) <= kLengthOff)) return {};
  for (double& part : parts) part /= length;
  return parts;
}

DeviceTraits read_common(Payload body, const RawLayout& layout) {
  DeviceTraits traits;
  traits.dof = body[RawAt::joints];
  check(traits.dof >= 1 && traits.dof <= static_cast<int>(layout.joints),
        fmt::format("it has {} joints", traits.dof),
        layout.joints == kRaw1.joints ? "1 to 6 are allowed" : "1 to 8 are allowed");
  traits.pushes = body[RawAt::flags] & RawFlag::motors;
  traits.rate = load_le<std::uint16_t>(body, RawAt::rate);
  const int watchdog = load_le<std::uint16_t>(body, RawAt::watchdog);
  if (traits.pushes) {
    check(traits.rate >= 500 && traits.rate <= 8000, fmt::format("its rate is {} Hz", traits.rate),
          "a device with motors must have 500 to 8000 Hz");
    check(watchdog >= 1 && watchdog <= 10, fmt::format("its watchdog takes {} ms", watchdog),
          "a device with motors must have 1 to 10 ms");
  }
  return traits;
}

void read_joint(Payload body, std::size_t joint, DeviceTraits& traits) {
  const double lower = milli_signed(load_le<std::uint16_t>(body, Raw1Feature::ranges + 4 * joint));
  const double upper =
      milli_signed(load_le<std::uint16_t>(body, Raw1Feature::ranges + 4 * joint + 2));
  check(lower < upper,
        fmt::format("the range of joint {} is {} to {} rad", joint + 1, lower, upper),
        "the lower end must be below the upper");
  traits.lower.push_back(lower);
  traits.upper.push_back(upper);
  if (!traits.pushes) return;
  const double effort = milli(load_le<std::uint16_t>(body, Raw1Feature::limits + 2 * joint));
  check(effort > 0, fmt::format("joint {} can push with 0 N m", joint + 1),
        "a joint with a motor must have a torque limit above 0");
  traits.effort.push_back(effort);
}

DeviceTraits read_traits(Payload body) {
  DeviceTraits traits = read_common(body, kRaw1);
  const float resolution = load_float_le(body, Raw1Feature::resolution);
  check(std::isfinite(resolution) && resolution > 0,
        fmt::format("its resolution is {} rad", resolution), "it must be above 0");
  const auto joints = static_cast<std::size_t>(traits.dof);
  traits.resolution.assign(joints, resolution);
  for (std::size_t i = 0; i < joints; ++i) read_joint(body, i, traits);
  traits.name =
      printable(body.subspan(Raw1Feature::name, Raw1Feature::name_end - Raw1Feature::name));
  return traits;
}

// Reads a joint of version 2; traits have slides in units of kSlideUnit.
void read_joint_of_any_kind(Payload body, std::size_t joint, DeviceTraits& traits) {
  const std::uint8_t kind = body[Raw2Feature::kinds + joint];
  check(kind <= 1, fmt::format("joint {} is of kind {}", joint + 1, kind),
        "allowed: 0 (joint rotates) and 1 (joint slides)");
  const bool slides = kind == 1;
  const double unit = slides ? kSlideUnit : 1, farthest = slides ? kFarthestSlide : kFarthestTurn;
  const char* const angle = slides ? "m" : "rad";
  const double lower = number_at(body, Raw2Feature::lower, joint);
  const double upper = number_at(body, Raw2Feature::upper, joint);
  check(lower < upper && lower >= -farthest && upper <= farthest,
        fmt::format("the range of joint {} is {} to {} {}", joint + 1, lower, upper, angle),
        slides ? "the lower end must be below the upper, both within 10 m"
               : "the lower end must be below the upper, both within 100 rad");
  const double resolution = number_at(body, Raw2Feature::resolution, joint);
  check(std::isfinite(resolution) && resolution > 0,
        fmt::format("the resolution of joint {} is {} {}", joint + 1, resolution, angle),
        "it must be above 0");
  const double effort = number_at(body, Raw2Feature::effort, joint);
  check(std::isfinite(effort) && effort >= 0,
        fmt::format("joint {} can push with {} {}", joint + 1, effort, slides ? "N" : "N m"),
        "it must be 0 (no motor) or more");
  const double speed = number_at(body, Raw2Feature::speed, joint);
  check(std::isfinite(speed) && speed >= 0,
        fmt::format("the largest speed of joint {} is {} {}/s", joint + 1, speed, angle),
        "it must be 0 (unknown) or more");
  traits.slides.push_back(slides);
  traits.lower.push_back(lower / unit);
  traits.upper.push_back(upper / unit);
  traits.resolution.push_back(resolution / unit);
  if (traits.pushes) traits.effort.push_back(effort * unit);
}

DeviceTraits read_traits_of_any_kind(Payload body) {
  DeviceTraits traits = read_common(body, kRaw2);
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits.dof); ++i) {
    read_joint_of_any_kind(body, i, traits);
  }
  const bool any = std::ranges::any_of(traits.effort, [](double each) { return each > 0; });
  check(!traits.pushes || any, "the device has motors, but no joint has a motor",
        "a device with motors must have a largest torque or force above 0");
  traits.name =
      printable(body.subspan(Raw2Feature::name, Raw2Feature::made_by - Raw2Feature::name));
  traits.made_by =
      printable(body.subspan(Raw2Feature::made_by, Raw2Feature::end - Raw2Feature::made_by));
  return traits;
}

}  // namespace

bool RawProtocol::describes(const ReportDescriptor& descriptor) {
  return std::find(descriptor.applications.begin(), descriptor.applications.end(), kApplication) !=
         descriptor.applications.end();
}

void RawProtocol::open(HidTransport& transport) {
  std::array<std::uint8_t, kFeature2Size> feature{};
  const auto ask = [&](std::size_t size) {
    return transport.get_feature(std::span(feature).first(size)) == static_cast<int>(size);
  };
  const Payload body = Payload(feature).subspan(1);
  // Firmware of version 1 is asked for as much as it has: some hang if they are asked for more.
  bool answered = ask(kReportSize);
  if (!answered || body[RawAt::version] == kRaw2.version) {
    const bool more = ask(kFeature2Size);
    answered = answered || more;
    if (more) layout_ = kRaw2;
  }
  if (!answered) {
    throw HidError("the device does not send its description when asked (feature report)");
  }
  if (!raw_undamaged(body.first(layout_.feature), layout_.version, layout_.feature)) {
    throw HidError("the device's feature report has a wrong magic, version or CRC");
  }
  if (layout_.version == kRaw1.version) {
    traits_ = read_traits(body);
  } else {
    traits_ = read_traits_of_any_kind(body);
    for (std::size_t i = 0; i < static_cast<std::size_t>(traits_.dof); ++i) {
      speed_[i] = number_at(body, Raw2Feature::speed, i);
    }
  }
  // Mode 0 is obeyed whatever its sequence is.
  const Command stop = command(RawMode::no_torque, 0);
  stop_reports_ = {Report(stop.begin(), stop.end())};
}

// Length or angle of a unit of the joint's coordinate.
double RawProtocol::unit(std::size_t joint) const {
  return joint < traits_.slides.size() && traits_.slides[joint] ? kSlideUnit : 1;
}

Decoded RawProtocol::decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept {
  if (report.empty() || report[0] != 0) return Decoded::unusable;
  const Payload body = report.subspan(1);
  if (!raw_undamaged(body, layout_.version, layout_.reading) ||
      body[RawAt::joints] != traits_.dof) {
    return Decoded::unusable;
  }
  // Drops repetitions: frozen firmware repeats itself, which must not pass for news.
  const auto sequence = load_le<std::uint32_t>(body, RawAt::sequence);
  if (reading_sequence_ && static_cast<std::int32_t>(sequence - *reading_sequence_) <= 0) {
    return Decoded::unusable;
  }
  const auto joints = static_cast<std::size_t>(traits_.dof);
  Positions x{};
  for (std::size_t i = 0; i < joints; ++i) {
    x[i] = number_at(body, RawAt::values, i);
    if (!std::isfinite(x[i])) return Decoded::unusable;
  }
  const std::uint8_t status = body[RawAt::flags];
  reading.hand = status & RawFlag::hand;
  reading.calibrated = status & RawFlag::calibrated;
  reading.fault = (status & RawFlag::fault) || !reading.calibrated;
  // The device did not get the torques sent as long as this bit is set.
  if (status & RawFlag::cut) ++reading.lapses;
  reading_sequence_ = sequence;
  time_stamp_ = load_le<std::uint64_t>(body, RawAt::time_stamp);
  if (layout_.version == kRaw2.version) return take_more(body, x, sequence, reading);
  std::copy_n(x.begin(), joints, reading.x.begin());
  return Decoded::reading;
}

// Takes what version 1 does not have. Positions that cannot be are a fault, and are not taken.
Decoded RawProtocol::take_more(Payload body, const Positions& x, std::uint32_t sequence,
                               DeviceReading& reading) noexcept {
  reading.buttons = load_le<std::uint32_t>(body, Raw2Reading::buttons);
  reading.buttons_known = ~0u;
  const std::uint8_t reason = body[Raw2Reading::no_force];
  reading.no_force = reason < kNoForces ? static_cast<NoForce>(reason) : NoForce::other;
  if (reading.no_force != NoForce::none && !(body[RawAt::flags] & RawFlag::cut)) ++reading.lapses;
  const float warmth = load_float_le(body, Raw2Reading::warmth);
  reading.warmth = std::isfinite(warmth) ? std::clamp(warmth, 0.f, 1.f) : 0.f;
  reading.orientation = orientation_in(body);
  for (std::size_t i = 0; i < extras_.measured.size(); ++i) {
    extras_.measured[i] = load_float_le(body, Raw2Reading::measured + 4 * i);
  }
  // The longer of two times: a device's clock may stand still.
  const double by_clock = 1e-6 * static_cast<double>(std::max<std::int64_t>(
                                     0, static_cast<std::int64_t>(time_stamp_ - believed_at_)));
  const double by_count =
      traits_.rate > 0 ? static_cast<double>(sequence - believed_sequence_) / traits_.rate : 0;
  if (!is_where_it_can_be(x, std::max(by_clock, by_count))) {
    reading.fault = true;
    return Decoded::status;
  }
  believed_ = x;
  believed_sequence_ = sequence;
  believed_at_ = time_stamp_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits_.dof); ++i) {
    reading.x[i] = x[i] / unit(i);
  }
  return Decoded::reading;
}

// Whether the joints can be at `x`, `dt` after they were last believed.
bool RawProtocol::is_where_it_can_be(const Positions& x, double dt) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(traits_.dof); ++i) {
    const double lower = unit(i) * traits_.lower[i], upper = unit(i) * traits_.upper[i];
    const double room = kBeyond * (upper - lower);
    if (x[i] < lower - room || x[i] > upper + room) return false;
    const double step = 2 * unit(i) * traits_.resolution[i];  // both ends are rounded
    if (believed_ && speed_[i] > 0 && std::abs(x[i] - (*believed_)[i]) > speed_[i] * dt + step) {
      return false;
    }
  }
  return true;
}

RawProtocol::Command RawProtocol::command(RawMode mode, std::uint32_t sequence) const {
  Command report{};
  const auto body = std::span(report).subspan(1);
  body[RawAt::magic] = kRawMagic;
  body[RawAt::version] = layout_.version;
  body[RawAt::joints] = static_cast<std::uint8_t>(traits_.dof);
  body[RawAt::flags] = static_cast<std::uint8_t>(mode);
  store_le(body, RawAt::sequence, sequence);
  store_le(body, RawAt::time_stamp, time_stamp_);
  store_le(body, layout_.answered, reading_sequence_.value_or(0));
  seal_raw_report(report);
  return report;
}

void RawProtocol::encode(std::span<const double> torque, nanoseconds,
                         const SendReport& send) noexcept {
  if (!traits_.pushes) return;
  const bool any = std::any_of(torque.begin(), torque.end(), [](double t) { return t != 0; });
  Command report = command(any ? RawMode::torque : RawMode::no_torque, ++command_sequence_);
  const auto body = std::span(report).subspan(1);
  for (std::size_t i = 0; i < std::min(torque.size(), layout_.joints); ++i) {
    store_float_le(body, RawAt::values + 4 * i, static_cast<float>(torque[i] / unit(i)));
  }
  seal_raw_report(report);
  send(report);
}

}  // namespace limpid
