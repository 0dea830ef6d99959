#include "devices/hid/pid_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/hid/hid_transport.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

namespace {

using namespace pid;

constexpr ReportKind kOut = ReportKind::output;
constexpr ReportKind kFeature = ReportKind::feature;

constexpr Usage axis_usage(int axis) {
  return make_usage(0x01, static_cast<std::uint16_t>(0x30 + axis));
}

// Angles from which effects push, clockwise from the far side. From the right a positive force
// pushes to the left, against X; from the far side it pushes towards the user, along Y. Some
// firmwares have it the other way round, but all of them keep the axes apart.
constexpr double kDegrees[] = {90, 0};
constexpr double kSign[] = {-1, 1};

void set(Report& report, const ReportField& field, std::int64_t value, std::uint32_t index = 0) {
  if (put_field(report, field, value, index)) return;
  throw HidError(fmt::format("report {} cannot contain the value {}", field.report_id, value));
}

// Chooses `usage` in a field that lists it, or switches on a field of this usage.
void choose(Report& report, const ReportField& field, Usage usage) {
  if (!field.array) return set(report, field, 1);
  const auto place = std::find(field.usages.begin(), field.usages.end(), usage);
  set(report, field, field.logical_min + (place - field.usages.begin()));
}

bool chosen(std::span<const std::uint8_t> report, const ReportField& field, Usage usage) {
  const auto value = get_field(report, field);
  if (!value) return false;
  if (!field.array) return *value != 0;
  const auto place = std::find(field.usages.begin(), field.usages.end(), usage);
  return *value == field.logical_min + (place - field.usages.begin());
}

constexpr double kMostTimes = 2;  // longest allowed effect, in times of the duration asked for

// The number in a duration field for so many seconds; at least 1, as 0 may mean for ever.
std::int64_t to_ticks(const ReportField& field, double seconds) {
  const bool in_seconds = (field.unit >> 12 & 0xF) == 1 && std::abs(field.unit_exponent) <= 9;
  const int exponent = in_seconds ? field.unit_exponent : -3;  // nearly all count milliseconds
  const double physical = seconds * std::pow(10, -exponent);
  const auto span = static_cast<double>(field.physical_max - field.physical_min);
  const auto steps = static_cast<double>(field.logical_max - field.logical_min);
  if (span <= 0 || steps <= 0 || field.logical_max < 1) {
    throw HidError("the force-feedback joystick's effect duration has no range");
  }
  const double ticks = static_cast<double>(field.logical_min) +
                       (physical - static_cast<double>(field.physical_min)) * steps / span;
  const auto lowest = static_cast<double>(std::max<std::int64_t>(1, field.logical_min));
  const double taken =
      std::round(std::clamp(ticks, lowest, static_cast<double>(field.logical_max)));
  const double lasts = (static_cast<double>(field.physical_min) +
                        (taken - static_cast<double>(field.logical_min)) * span / steps) *
                       std::pow(10, exponent);
  if (lasts > kMostTimes * seconds) {
    throw HidError(
        fmt::format("the force-feedback joystick's shortest effect lasts {:.3g} ms; needed: at "
                    "most {:.3g} ms, so that a force that nobody renews ends by itself",
                    1e3 * lasts, 1e3 * kMostTimes * seconds));
  }
  return static_cast<std::int64_t>(taken);
}

// Degrees of one of the field's physical units; 0 if unknown. Most firmwares count hundredths and
// leave out the unit, but only degrees make about 360 of a circle.
double degrees_per_number(const ReportField& field) {
  const auto span = static_cast<double>(field.physical_max - field.physical_min);
  const bool radians = (field.unit & 0xF) == 2 && (field.unit >> 4 & 0xF) == 1;
  const double one =
      std::pow(10, std::clamp(field.unit_exponent, -9, 9)) * (radians ? 180 / std::numbers::pi : 1);
  return span > 0 && std::abs(span * one - 360) < 36 ? one : 0;
}

// The number in a direction field for this angle. A field that says nothing of degrees holds one
// circle.
std::int64_t to_direction(const ReportField& field, double degrees) {
  const auto steps = static_cast<double>(field.logical_max - field.logical_min);
  double part = degrees / 360;
  if (const double one = degrees_per_number(field); one > 0) {
    const double first = one * static_cast<double>(field.physical_min);
    const double last = one * static_cast<double>(field.physical_max);
    const double within = degrees < first  ? degrees + 360
                          : degrees > last ? degrees - 360
                                           : degrees;
    part = (within - first) / (last - first);
  }
  return field.logical_min + std::llround(std::clamp(part, 0.0, 1.0) * steps);
}

double full_force(const ReportField& magnitude) {
  return static_cast<double>(std::min(-magnitude.logical_min, magnitude.logical_max));
}

}  // namespace

PidReports::PidReports(ReportDescriptor descriptor) : descriptor_(std::move(descriptor)) {
  if (!descriptor_.find(kFeature, kTypeConstantForce, kCreateNewEffect)) {
    throw HidError(
        "the force-feedback joystick has no Create New Effect report with constant force: the "
        "computer must manage the joystick's memory, or the joystick cannot give a constant force; "
        "this is not supported");
  }
  need(kFeature, kBlockIndex, kBlockLoad, "PID Block Load");
  need(kFeature, kLoadSuccess, kBlockLoad, "Block Load Status");
  need(kOut, kBlockIndex, kSetEffect, "Set Effect");
  need(kOut, kTypeConstantForce, kSetEffect, "Effect Type");
  need(kOut, kDuration, kSetEffect, "Duration");
  need(kOut, kBlockIndex, kSetConstantForce, "Set Constant Force");
  need(kOut, kBlockIndex, kEffectOperation, "Effect Operation");
  need(kOut, kEffectStart, kEffectOperation, "Effect Start");
  need(kOut, kEffectStop, kEffectOperation, "Effect Stop");
  need(kOut, kStopAllEffects, kDeviceControl, "Stop All Effects");
  magnitude_ = need(kOut, kMagnitude, kSetConstantForce, "Magnitude");
  if (magnitude_.logical_min >= 0 || magnitude_.logical_max <= 0) {
    throw HidError(
        "the constant force of the force-feedback joystick has only one direction; this is not "
        "supported");
  }
  Report trial = blank(magnitude_);
  set(trial, magnitude_, std::llround(full_force(magnitude_)));
  set(trial, magnitude_, -std::llround(full_force(magnitude_)));
  by_angle_ = by_angle();
}

const ReportField& PidReports::need(ReportKind kind, Usage usage, Usage within,
                                    const char* name) const {
  const ReportField* field = descriptor_.find(kind, usage, within);
  if (!field) throw HidError(fmt::format("the force-feedback joystick does not describe {}", name));
  return *field;
}

Report PidReports::blank(const ReportField& field) const {
  Report report(descriptor_.report_bytes(field.kind, field.report_id));
  report[0] = field.report_id;
  return report;
}

std::optional<Report> PidReports::device_control(Usage what) const {
  const ReportField* field = descriptor_.find(kOut, what, kDeviceControl);
  if (!field) return std::nullopt;
  Report report = blank(*field);
  choose(report, *field, what);
  return report;
}

std::optional<Report> PidReports::full_gain() const {
  const ReportField* field = descriptor_.find(kOut, kDeviceGain, kDeviceGainReport);
  if (!field) return std::nullopt;
  Report report = blank(*field);
  set(report, *field, field->logical_max);
  return report;
}

Report PidReports::create_constant_force() const {
  const auto& type = need(kFeature, kTypeConstantForce, kCreateNewEffect, "Create New Effect");
  Report report = blank(type);
  choose(report, type, kTypeConstantForce);
  return report;
}

Report PidReports::block_load() const {
  return blank(need(kFeature, kBlockIndex, kBlockLoad, "PID Block Load"));
}

std::optional<int> PidReports::created(std::span<const std::uint8_t> block_load) const {
  const ReportField* full = descriptor_.find(kFeature, kLoadFull, kBlockLoad);
  if (full && chosen(block_load, *full, kLoadFull)) {
    throw HidError("the force-feedback joystick has no memory left for another effect");
  }
  const ReportField* error = descriptor_.find(kFeature, kLoadError, kBlockLoad);
  if (error && chosen(block_load, *error, kLoadError)) {
    throw HidError("the force-feedback joystick cannot make an effect of constant force");
  }
  const auto& status = need(kFeature, kLoadSuccess, kBlockLoad, "Block Load Status");
  if (!chosen(block_load, status, kLoadSuccess)) return std::nullopt;
  const auto& index = need(kFeature, kBlockIndex, kBlockLoad, "PID Block Load");
  const auto block = get_field(block_load, index);
  if (!block || *block < 1 || *block > 255) return std::nullopt;
  return static_cast<int>(*block);
}

Report PidReports::set_effect(int block, int axis, double duration) const {
  const auto& index = need(kOut, kBlockIndex, kSetEffect, "Set Effect");
  const auto& type = need(kOut, kTypeConstantForce, kSetEffect, "Effect Type");
  const auto& lasting = need(kOut, kDuration, kSetEffect, "Duration");
  Report report = blank(index);
  set(report, index, block);
  choose(report, type, kTypeConstantForce);
  set(report, lasting, to_ticks(lasting, duration));
  if (const ReportField* gain = descriptor_.find(kOut, kGain, kSetEffect)) {
    set(report, *gain, gain->logical_max);
  }
  set_direction(report, axis);
  return report;
}

// Sets the direction by an angle: with most firmwares the axis' enable bit pushes on the wrong
// axis, and some take the angle only if no axis is enabled. Of two direction fields some firmwares
// read the first for both axes, others one for each axis; therefore both hold the same. Of three,
// the second may be an axis that is not to be pushed.
void PidReports::set_direction(Report& report, int axis) const {
  if (!by_angle_) {
    if (!names_axis(axis)) {
      throw HidError("the force-feedback joystick does not describe a direction of effects");
    }
    set(report, *descriptor_.find(kOut, axis_usage(axis), kAxesEnable), 1);
    return;
  }
  if (const auto* enable = descriptor_.find(kOut, kDirectionEnable, kSetEffect)) {
    set(report, *enable, 1);
  }
  std::uint32_t values = 0;
  for (const ReportField& field : descriptor_.fields) {
    if (is_direction(field)) values += field.count;
  }
  std::uint32_t left = values == 2 ? 2 : 1;
  for (const ReportField& field : descriptor_.fields) {
    if (!is_direction(field)) continue;
    for (std::uint32_t i = 0; i < field.count && left > 0; ++i, --left) {
      set(report, field, to_direction(field, kDegrees[axis]), i);
    }
  }
}

bool PidReports::is_direction(const ReportField& field) const {
  return field.kind == kOut && field.within(kSetEffect) && field.within(kDirection);
}

bool PidReports::by_angle() const {
  const auto& fields = descriptor_.fields;
  const bool has_direction = std::any_of(
      fields.begin(), fields.end(), [&](const ReportField& field) { return is_direction(field); });
  const bool can_enable = descriptor_.find(kOut, kDirectionEnable, kSetEffect) != nullptr;
  return has_direction && (can_enable || !names_axes());
}

bool PidReports::names_axis(int axis) const {
  return descriptor_.find(kOut, axis_usage(axis), kAxesEnable) != nullptr;
}

bool PidReports::names_axes() const {
  const auto& fields = descriptor_.fields;
  return std::any_of(fields.begin(), fields.end(), [](const ReportField& field) {
    return field.kind == kOut && field.within(kAxesEnable);
  });
}

Report PidReports::constant_force(int block) const {
  const auto& index = need(kOut, kBlockIndex, kSetConstantForce, "Set Constant Force");
  Report report = blank(index);
  set(report, index, block);
  set(report, magnitude_, 0);
  return report;
}

std::int64_t PidReports::force_level(int axis, double strength) const noexcept {
  const double sign = by_angle_ ? kSign[axis] : 1;
  return std::llround(sign * std::clamp(strength, -1.0, 1.0) * full_force(magnitude_));
}

void PidReports::set_force(Report& constant_force, std::int64_t level) const noexcept {
  put_field(constant_force, magnitude_, level);  // cannot fail, as the constructor has tried it
}

Report PidReports::operation(int block, bool start) const {
  const Usage what = start ? kEffectStart : kEffectStop;
  const auto& index = need(kOut, kBlockIndex, kEffectOperation, "Effect Operation");
  const auto& field = need(kOut, what, kEffectOperation, "Effect Start");
  Report report = blank(index);
  set(report, index, block);
  choose(report, field, what);
  if (const ReportField* loops = descriptor_.find(kOut, kLoopCount, kEffectOperation)) {
    set(report, *loops, start ? 1 : 0);
  }
  return report;
}

std::optional<Report> PidReports::block_free(int block) const {
  const ReportField* index = descriptor_.find(kOut, kBlockIndex, kBlockFree);
  if (!index) return std::nullopt;
  Report report = blank(*index);
  set(report, *index, block);
  return report;
}

bool PidReports::drives(int axis) const { return !names_axes() || names_axis(axis); }

}  // namespace limpid
