#include "tests/support/hid/raw_device_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/hid/descriptor_writer.h"

namespace limpid::test {

namespace {

constexpr std::size_t kSize = 64, kCrcAt = 60;
constexpr std::uint8_t kMagic = 0x4C, kVersion = 1;

Report describe() {
  using Kind = DescriptorWriter::Kind;
  DescriptorWriter writer;
  writer.page(0xFF4C).usage(0x01).begin(DescriptorWriter::kApplication).logical(0, 255);
  writer.usage(0x02).field(Kind::input, 8, kSize);
  writer.usage(0x03).field(Kind::output, 8, kSize);
  writer.usage(0x04).field(Kind::feature, 8, kSize);
  return writer.end().descriptor();
}

Report message(const RawDeviceLayout& layout, std::uint8_t fourth) {
  Report report(kSize);
  report[0] = kMagic;
  report[1] = kVersion;
  report[2] = static_cast<std::uint8_t>(layout.joints);
  report[3] = fourth;
  return report;
}

void seal(Report& report) { write_at(report, kCrcAt, crc32_of(std::span(report).first(kCrcAt))); }

bool all_zero(ReportView bytes) {
  return std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0; });
}

float torque_at(ReportView message, std::size_t joint) {
  return read_at<float>(message, 16 + 4 * joint);
}

}  // namespace

RawDeviceModel::RawDeviceModel(const RawDeviceLayout& layout)
    : ReferenceDevice(layout.identity, describe(), layout.period),
      layout_(layout),
      hand_(std::vector<AxisPhysics>(static_cast<std::size_t>(layout.joints), layout.physics)) {}

void RawDeviceModel::restart(Time now) {
  start_ = fed_ = now;
  torque_ = {};
  cut_ = addressed_ = false;
  sequence_ = command_ = 0;
  hand_.begin(now);
}

void RawDeviceModel::run(Time now) {
  hand_.run(now, [&](Time step) {
    for (; !late_.empty() && late_.front().first <= step; late_.pop_front()) {
      act(late_.front().second, step, ForceCause::told);
    }
    const bool missed = step - fed_ > layout_.watchdog && fault() != Fault::frozen;
    if (missed && torque_ != Torque{}) {
      cut_ = true;
      act({}, step, ForceCause::watchdog);
    }
    return motors_ ? torque_ : Torque{};
  });
}

void RawDeviceModel::act(const Torque& torque, Time now, ForceCause cause) {
  torque_ = torque;
  forces().note(now, motors_ ? torque : Torque{}, cause);
}

void RawDeviceModel::set_motors(bool powered, Time now) {
  run(now);
  motors_ = powered;
  act(torque_, now, ForceCause::power);
}

std::vector<Report> RawDeviceModel::next_input(Time now) {
  const int status = (motors_ ? 1 : 0) | (hand_.held() ? 2 : 0) | (calibrated_ ? 4 : 0) |
                     (unwell_ ? 8 : 0) | (cut_ ? 16 : 0);
  Report report = message(layout_, static_cast<std::uint8_t>(status));
  stamp_ = static_cast<std::uint64_t>((now - start_).count() / 1000);
  write_at(report, 4, ++sequence_);
  write_at(report, 8, stamp_);
  for (int joint = 0; joint < layout_.joints; ++joint) {
    double x = hand_.encoder(joint);
    if (layout_.resolution > 0) x = std::round(x / layout_.resolution) * layout_.resolution;
    if (fault() == Fault::not_a_number) x = std::numeric_limits<double>::quiet_NaN();
    write_at(report, 16 + 4 * static_cast<std::size_t>(joint), static_cast<float>(x));
  }
  write_at(report, 40, command_);
  seal(report);
  return {report};
}

void RawDeviceModel::on_output(ReportView report, Time now) {
  const ReportView message = report.empty() ? report : report.subspan(1);  // without the id, 0
  if (report.empty() || report[0] != 0 || !well_formed(message) || !follows(message)) {
    ++rejected_;
    return;
  }
  check_manners(message);
  const auto number = read_at<std::uint32_t>(message, 4);
  const bool session_edge = message[3] == 0 && number <= 1;
  if (addressed_ && !session_edge && number != command_ + 1) ++gaps_;
  addressed_ = true;
  ++commands_;
  command_ = number;
  fed_ = now;
  cut_ = false;
  Torque torque{};
  const double limit = layout_.pushes ? layout_.torque_limit : 0;
  for (std::size_t i = 0; message[3] == 1 && i < static_cast<std::size_t>(layout_.joints); ++i) {
    torque[i] = std::clamp(static_cast<double>(torque_at(message, i)), -limit, limit);
  }
  if (layout_.lag > Time{}) {
    late_.emplace_back(now + layout_.lag, torque);
  } else {
    act(torque, now, ForceCause::told);
  }
}

bool RawDeviceModel::well_formed(ReportView message) const {
  if (message.size() != kSize || message[0] != kMagic || message[1] != kVersion) return false;
  if (message[2] != layout_.joints) return false;
  if (read_at<std::uint32_t>(message, kCrcAt) != crc32_of(message.first(kCrcAt))) return false;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!std::isfinite(torque_at(message, i))) return false;
  }
  return true;
}

// Whether the command is obeyed: in mode 1 the sequence has to increase, mode 0 always is.
bool RawDeviceModel::follows(ReportView message) const {
  const auto number = read_at<std::uint32_t>(message, 4);
  return message[3] == 0 || !addressed_ || static_cast<std::int32_t>(number - command_) > 0;
}

// Notes what a device has to tolerate but a good host does not send.
void RawDeviceModel::check_manners(ReportView message) {
  if (message[3] > 1) violation("mode " + std::to_string(message[3]));
  if (!all_zero(message.subspan(44, 16))) violation("reserved bytes are not zero");
  if (read_at<std::uint64_t>(message, 8) > stamp_) violation("a time stamp never sent");
  if (read_at<std::uint32_t>(message, 40) > sequence_) violation("answers a reading never sent");
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double torque = torque_at(message, i);
    const bool joint = i < static_cast<std::size_t>(layout_.joints);
    if (!joint && torque != 0) violation("torque for a joint that is not there");
    if (std::abs(torque) > layout_.torque_limit * (1 + 1e-6)) violation("torque over the limit");
  }
}

std::optional<Report> RawDeviceModel::on_get_feature(std::uint8_t id) {
  if (id != 0) return std::nullopt;
  Report report = message(layout_, layout_.pushes ? 1 : 0);
  const auto milli = [](double value) {
    return static_cast<std::int16_t>(std::lround(1e3 * value));
  };
  write_at(report, 4, static_cast<std::uint16_t>(std::chrono::seconds(1) / layout_.period));
  write_at(report, 6, static_cast<std::uint16_t>(layout_.watchdog / std::chrono::milliseconds(1)));
  for (int i = 0; i < layout_.joints; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    write_at(report, 8 + 4 * joint, milli(hand_.axis(i).lower));
    write_at(report, 10 + 4 * joint, milli(hand_.axis(i).upper));
    write_at(report, 36 + 2 * joint, static_cast<std::uint16_t>(milli(layout_.torque_limit)));
  }
  write_at(report, 32, static_cast<float>(layout_.resolution));
  const std::string name = layout_.identity.name.substr(0, 12);
  std::ranges::copy(name, report.begin() + 48);
  seal(report);
  report.insert(report.begin(), 0);
  return report;
}

}  // namespace limpid::test
