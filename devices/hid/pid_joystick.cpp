#include "devices/hid/pid_joystick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "devices/hid/hid_transport.h"
#include "devices/hid/pid_reports.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {
namespace {

using namespace pid;

constexpr int kMostAxes = 2;
constexpr int kLoadTries = 20;
constexpr std::chrono::milliseconds kLoadPause{5};
constexpr Usage kGamePad = make_usage(0x01, 0x05);
constexpr double kUsualRate = 125;  // of HID devices; the report descriptor does not say [Hz]

const ReportField* find_position(const ReportDescriptor& descriptor, int axis) {
  const ReportField* field =
      descriptor.find(ReportKind::input, make_usage(0x01, static_cast<std::uint16_t>(0x30 + axis)));
  return field && !field->array && field->logical_max > field->logical_min ? field : nullptr;
}

void require_within(double value, double most, const char* name) {
  if (value > 0 && value <= most) return;
  throw HidError(fmt::format("force-feedback joystick: {} is {}; needed: above 0, at most {}", name,
                             value, most));
}

void send_or_throw(HidTransport& transport, const std::optional<Report>& report) {
  if (report && !transport.write(*report)) {
    throw HidError("the force-feedback joystick does not accept its reports");
  }
}

}  // namespace

bool PidJoystick::describes(const ReportDescriptor& descriptor) {
  return find_position(descriptor, 0) &&
         descriptor.find(ReportKind::output, kBlockIndex, kSetConstantForce);
}

// Refuses game pads. Joysticks and wheels, which move, have the usage Joystick; pads that shake
// declare constant forces, too, for programs that know no other effect.
std::string PidJoystick::objection(const ReportDescriptor& descriptor) {
  const ReportField* position = find_position(descriptor, 0);
  if (!position || !position->within(kGamePad)) return {};
  return "the device calls itself a game pad: the motors shake the hand but do not move the stick, "
         "so the device cannot be an arm";
}

PidJoystick::PidJoystick(const ReportDescriptor& descriptor, const PidSettings& settings)
    : settings_(settings), reports_(descriptor), buttons_(button_fields(descriptor)) {
  if (std::string why = objection(descriptor); !why.empty()) throw HidError(why);
  require_within(settings.range, 100, "range [rad]");
  require_within(settings.effort, 100, "effort [N m]");
  require_within(settings.duration, 0.1, "duration [s]");
  require_within(settings.restart, settings.duration, "restart [s]");
  for (int i = 0; i < kMostAxes; ++i) {
    const ReportField* position = find_position(descriptor, i);
    if (!position || !reports_.drives(i)) continue;
    const std::size_t joint = axes_.size();
    Axis& axis = axes_.emplace_back();
    axis.number = i;
    axis.position = *position;
    axis.sign = settings.reverse[joint] ? -1 : 1;
    const auto steps = static_cast<double>(position->logical_max - position->logical_min);
    traits_.resolution.push_back(2 * settings.range / steps);
  }
  if (axes_.empty()) throw HidError("the force-feedback joystick has no axis with a force");
  for (const Usage usage : {kDevicePaused, kActuatorsEnabled, kSafetySwitch, kActuatorPower}) {
    const ReportField* field = descriptor.find(ReportKind::input, usage, kState);
    if (field && !field->array) state_.push_back({*field, usage});
  }
  const std::uint8_t id = axes_[0].position.report_id;
  silent_report_.resize(descriptor.report_bytes(ReportKind::input, id));
  silent_report_[0] = id;
  traits_.dof = static_cast<int>(axes_.size());
  traits_.pushes = true;
  traits_.lower.assign(axes_.size(), -settings.range);
  traits_.upper.assign(axes_.size(), settings.range);
  traits_.effort.assign(axes_.size(), settings.effort);
  traits_.rate = kUsualRate;
}

// Stops all effects, which also ends the spring with which some devices centre themselves.
void PidJoystick::open(HidTransport& transport) {
  send_or_throw(transport, reports_.device_control(kDeviceReset));
  send_or_throw(transport, reports_.device_control(kStopAllEffects));
  send_or_throw(transport, reports_.full_gain());
  for (Axis& axis : axes_) {
    axis.block = create_effect(transport);
    axis.force = reports_.constant_force(axis.block);
    axis.start = reports_.start(axis.block);
    axis.level = 0;
    axis.news = false;
    send_or_throw(transport, reports_.set_effect(axis.block, axis.number, settings_.duration));
    send_or_throw(transport, axis.force);
  }
  make_stop_reports();
  send_or_throw(transport, reports_.device_control(kDeviceContinue));
  send_or_throw(transport, reports_.device_control(kEnableActuators));
}

int PidJoystick::create_effect(HidTransport& transport) const {
  if (!transport.set_feature(reports_.create_constant_force())) {
    throw HidError("the force-feedback joystick does not accept a new effect");
  }
  Report load = reports_.block_load();
  const std::uint8_t id = load[0];
  for (int i = 0; i < kLoadTries; ++i) {
    load[0] = id;
    const int size = transport.get_feature(load);
    if (size > 0) {
      const auto bytes = std::min(static_cast<std::size_t>(size), load.size());
      if (const auto block = reports_.created(std::span(load).first(bytes))) return *block;
    }
    std::this_thread::sleep_for(kLoadPause);
  }
  throw HidError("the force-feedback joystick does not report the index of its new effect");
}

// Makes redundant reports: whichever of them a device understands, its motors end without force.
void PidJoystick::make_stop_reports() {
  stop_reports_.clear();
  const auto add = [&](const std::optional<Report>& report) {
    if (report) stop_reports_.push_back(*report);
  };
  for (const Axis& axis : axes_) add(axis.force);
  for (const Axis& axis : axes_) add(reports_.stop(axis.block));
  add(reports_.device_control(kStopAllEffects));
  add(reports_.device_control(kDisableActuators));
  for (const Axis& axis : axes_) add(reports_.block_free(axis.block));
}

Decoded PidJoystick::decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept {
  if (report.empty()) return Decoded::unusable;
  DeviceReading read = reading;
  const auto positions = decode_positions(report, read);
  if (!positions) return Decoded::unusable;
  const bool any = std::ranges::count(*positions, true) > 0;
  const bool buttons = decode_buttons(report, buttons_, read.buttons, read.buttons_known);
  const bool state = decode_state(report, read);
  if (!any && !buttons && !state) return Decoded::unusable;
  reading = read;
  if (!any) return Decoded::status;
  // If each axis comes in a report of its own, the last of them completes a reading.
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].news = axes_[i].news || (*positions)[i];
  if (!std::ranges::all_of(axes_, &Axis::news)) return Decoded::status;
  for (Axis& axis : axes_) axis.news = false;
  return Decoded::reading;
}

// A number out of its range means that the device does not know the axis' position (USB HID 1.11,
// null values); then none of the report's numbers is used.
std::optional<std::array<bool, 2>> PidJoystick::decode_positions(
    std::span<const std::uint8_t> report, DeviceReading& reading) const noexcept {
  std::array<bool, 2> here{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const ReportField& field = axes_[i].position;
    if (report[0] != field.report_id) continue;
    const auto value = get_field(report, field);
    if (!value || *value < field.logical_min || *value > field.logical_max) {
      return std::nullopt;
    }
    const auto span = static_cast<double>(field.logical_max - field.logical_min);
    const double part = static_cast<double>(*value - field.logical_min) / span;
    reading.x[i] = settings_.range * (2 * part - 1);
    here[i] = true;
  }
  return here;
}

// A bit reports a fault only after it has reported that all is well, as firmwares leave out bits
// that they do not know. OpenFFBoard never closes its safety switch; it reports a pause when an
// effect is made, and nothing more once it goes on.
bool PidJoystick::decode_state(std::span<const std::uint8_t> report,
                               DeviceReading& reading) noexcept {
  bool any = false;
  for (StateBit& bit : state_) {
    if (report[0] != bit.field.report_id) continue;
    const auto on = get_field(report, bit.field);
    if (!on) continue;
    any = true;
    bit.well = (*on != 0) == (bit.usage != kDevicePaused);
    bit.was_well = bit.was_well || bit.well;
  }
  if (!any) return false;
  reading.hand = true;
  reading.fault = false;
  for (const StateBit& bit : state_) {
    if (bit.well || !bit.was_well) continue;
    if (bit.usage == kSafetySwitch) {
      reading.hand = false;
    } else {
      reading.fault = true;
    }
  }
  return true;
}

// The lost report's axis is not known, so the next forces are sent whatever they are. A zero, above
// all, would else be lost as long as the other axis pushes.
void PidJoystick::undelivered() noexcept {
  for (Axis& axis : axes_) axis.level = kUnknown;
}

// Sends a changed force at once, one that ends before others. Starts effects again long before they
// end, with their forces in case a report was lost.
void PidJoystick::encode(std::span<const double> torque, nanoseconds now,
                         const SendReport& send) noexcept {
  const auto restart =
      std::chrono::duration_cast<nanoseconds>(std::chrono::duration<double>(settings_.restart));
  bool any = false;
  const bool due = !playing_ || now - started_ >= restart;
  std::array<std::int64_t, kMostAxes> level{};
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double asked = i < torque.size() ? axes_[i].sign * torque[i] / settings_.effort : 0;
    level[i] = reports_.force_level(axes_[i].number, asked);
    any = any || level[i] != 0;
  }
  for (const bool zeros : {true, false}) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      Axis& axis = axes_[i];
      if ((level[i] == 0) != zeros) continue;
      if (level[i] == axis.level && !(due && level[i] != 0)) continue;
      axis.level = level[i];
      reports_.set_force(axis.force, axis.level);
      send(axis.force);
    }
  }
  if (!any || !due) return;
  for (const Axis& axis : axes_) send(axis.start);
  started_ = now;
  playing_ = true;
}

}  // namespace limpid
