// 3Dconnexion's hand controllers: a cap that is pushed and turned, with six numbers and no motors.
//
// The report descriptor tells which bytes they are. Two kinds are in use: translation in report 1
// and rotation in report 2, or all six in report 1. Some devices send the latter and describe the
// former.
#pragma once

#include <array>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

// Driver with six "joints": X, Y, Z, Rx, Ry, Rz of the cap in -1..1 of full deflection, in the
// device's own axes (X right, Y towards the user, Z down). The device is silent while the cap
// rests.
class SpaceMouse final : public HidProtocol {
 public:
  static bool describes(const ReportDescriptor& descriptor);

  // Throws HidError if an axis is missing.
  explicit SpaceMouse(const ReportDescriptor& descriptor);

  void open(HidTransport& transport) override;
  const DeviceTraits& traits() const override { return traits_; }
  nanoseconds stale_after() const override { return nanoseconds::max(); }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override;
  void encode(std::span<const double>, nanoseconds, const SendReport&) noexcept override {}
  const std::vector<Report>& stop_reports() const override { return no_reports_; }

 private:
  static constexpr std::size_t kAxes = 6;

  bool decode_axes(std::span<const std::uint8_t> report, DeviceReading& reading) const noexcept;

  DeviceTraits traits_;
  std::array<ReportField, kAxes> axes_;
  std::vector<ReportField> joined_;  // rotation behind translation, if that is not described
  std::vector<ReportField> buttons_;
  std::vector<Report> no_reports_;
};

}  // namespace limpid
