// The reports by which a USB PID device is told to push, filled in as its descriptor says.
//
// PID knows no N m and no fixed bytes: every device chooses its report ids, field sizes and ranges.
#pragma once

#include <optional>
#include <vector>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

class PidReports {
 public:
  // Throws HidError naming what the device lacks.
  explicit PidReports(ReportDescriptor descriptor);

  // One of the usages of the Device Control collection; nothing if the device does not know it.
  std::optional<Report> device_control(Usage what) const;
  // The strength of all effects at its most; nothing if it cannot be set.
  std::optional<Report> full_gain() const;

  // Feature reports: asks for room for a constant force; how that went, with only its id yet.
  Report create_constant_force() const;
  Report block_load() const;
  // The index of the new effect in the filled block load report; nothing if it is not ready.
  // Throws HidError if the device has no room or refuses.
  std::optional<int> created(std::span<const std::uint8_t> block_load) const;

  // `axis`: 0 for X, 1 for Y; it lasts for `duration` [s] after each start.
  Report set_effect(int block, int axis, double duration) const;
  // The force of an effect, 0 at first.
  Report constant_force(int block) const;
  // What to set for -1..1 of full strength, positive towards positive X or Y; equal levels are the
  // same force.
  std::int64_t force_level(int axis, double strength) const noexcept;
  void set_force(Report& constant_force, std::int64_t level) const noexcept;
  Report start(int block) const { return operation(block, true); }
  Report stop(int block) const { return operation(block, false); }
  std::optional<Report> block_free(int block) const;

  // Whether it can push along this axis.
  bool drives(int axis) const;

 private:
  const ReportField& need(ReportKind kind, Usage usage, Usage within, const char* name) const;
  Report blank(const ReportField& field) const;
  Report operation(int block, bool start) const;
  void set_direction(Report& report, int axis) const;
  bool is_direction(const ReportField& field) const;
  bool by_angle() const;            // effects say where they push from
  bool names_axis(int axis) const;  // they can be enabled for this axis
  bool names_axes() const;          // for any

  ReportDescriptor descriptor_;
  ReportField magnitude_;
  bool by_angle_ = false;
};

}  // namespace limpid
