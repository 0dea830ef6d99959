#include "devices/hid/space_mouse.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/hid/hid_transport.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {
namespace {

constexpr std::uint16_t kDesktop = 0x01;
constexpr Usage kMultiAxis = make_usage(kDesktop, 0x08);
constexpr std::uint16_t kX = 0x30;  // Y, Z, Rx, Ry, Rz follow

const ReportField* find_axis(const ReportDescriptor& descriptor, std::size_t axis) {
  const ReportField* field = descriptor.find(
      ReportKind::input, make_usage(kDesktop, static_cast<std::uint16_t>(kX + axis)), kMultiAxis);
  const bool usable = field && !field->array && field->logical_min < 0 && field->logical_max > 0;
  return usable ? field : nullptr;
}

// Part of full deflection; a cap may go a little beyond its declared range.
double deflection(const ReportField& axis, std::int64_t value) {
  const auto full = static_cast<double>(std::min(-axis.logical_min, axis.logical_max));
  return std::clamp(static_cast<double>(value) / full, -1.0, 1.0);
}

}  // namespace

bool SpaceMouse::describes(const ReportDescriptor& descriptor) {
  return std::find(descriptor.applications.begin(), descriptor.applications.end(), kMultiAxis) !=
         descriptor.applications.end();
}

SpaceMouse::SpaceMouse(const ReportDescriptor& descriptor) {
  for (std::size_t i = 0; i < kAxes; ++i) {
    const ReportField* axis = find_axis(descriptor, i);
    if (!axis) throw HidError(fmt::format("the space mouse describes {} of its 6 axes", i));
    axes_[i] = *axis;
    const double full = static_cast<double>(std::min(-axis->logical_min, axis->logical_max));
    traits_.resolution.push_back(1 / full);
  }
  if (axes_[3].report_id != axes_[0].report_id) {
    const ReportField& last = axes_[2];
    for (std::size_t i = 3; i < kAxes; ++i) {
      ReportField field = axes_[i];
      field.report_id = last.report_id;
      field.bit_offset = last.bit_offset + static_cast<std::uint32_t>(i - 2) * last.bit_size;
      field.bit_size = last.bit_size;
      joined_.push_back(field);
    }
  }
  buttons_ = button_fields(descriptor);
  traits_.dof = static_cast<int>(kAxes);
  traits_.lower.assign(kAxes, -1);
  traits_.upper.assign(kAxes, 1);
  traits_.rate = 60;  // while the cap moves
}

void SpaceMouse::open(HidTransport&) {}

Decoded SpaceMouse::decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept {
  const bool axes = decode_axes(report, reading);
  const bool buttons = decode_buttons(report, buttons_, reading.buttons, reading.buttons_known);
  // Buttons that have a report of their own are silent until one changes. Nothing here pushes, so
  // they may count as released until then.
  if (axes && !buttons) reading.buttons_known = ~0u;
  return axes ? Decoded::reading : buttons ? Decoded::status : Decoded::unusable;
}

bool SpaceMouse::decode_axes(std::span<const std::uint8_t> report,
                             DeviceReading& reading) const noexcept {
  if (report.empty()) return false;
  bool any = false;
  const auto take = [&](std::size_t i, const ReportField& field) {
    if (report[0] != field.report_id) return;
    if (const auto value = get_field(report, field)) {
      reading.x[i] = deflection(field, *value);
      any = true;
    }
  };
  for (std::size_t i = 0; i < kAxes; ++i) take(i, axes_[i]);
  for (std::size_t i = 0; i < joined_.size(); ++i) take(3 + i, joined_[i]);
  return any;
}

}  // namespace limpid
