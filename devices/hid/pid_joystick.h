// Force-feedback joysticks and wheels with USB PID (USB Device Class Definition for PID 1.0).
//
// Each axis has a constant force of its own. Forces are short effects that are started again and
// again: a device that hears no more from us drops its force by itself. The device's descriptor
// gives the layout of all reports; nothing here knows a product.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/pid_reports.h"

namespace limpid {

// Settings that PID does not tell and only the owner of the device knows.
struct PidSettings {
  double range = 0.349;           // an axis goes from -range to range: +-20 degrees [rad]
  double effort = 0.5;            // torque at full force [N m]
  double duration = 0.010;        // of an effect that is not started again, at most 0.1 [s]
  double restart = 0.004;         // time until it is started again, less than the duration [s]
  std::array<bool, 2> reverse{};  // joints pushed the wrong way; products differ (axis_check.h)
};

// Driver with joints X (positive to the right) and Y (positive towards the user), or X alone.
class PidJoystick final : public HidProtocol {
 public:
  static bool describes(const ReportDescriptor& descriptor);
  // The reason why a device that it describes cannot be an arm, for people; empty if it may be one.
  // Only trying shows whether its motors move it (axis_check.h).
  static std::string objection(const ReportDescriptor& descriptor);

  // Throws HidError naming what the device lacks, why it is no arm, or which setting is out of
  // range.
  explicit PidJoystick(const ReportDescriptor& descriptor, const PidSettings& settings = {});

  // Resets the device, makes its effects and switches its motors on, all forces 0.
  void open(HidTransport& transport) override;

  const DeviceTraits& traits() const override { return traits_; }
  // Joysticks that report more seldom, or only changes, are asked meanwhile.
  nanoseconds stale_after() const override { return std::chrono::milliseconds(5); }
  std::span<const std::uint8_t> silent_report() const override { return silent_report_; }
  Decoded decode(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept override;
  void encode(std::span<const double> torque, nanoseconds now,
              const SendReport& send) noexcept override;
  void undelivered() noexcept override;
  const std::vector<Report>& stop_reports() const override { return stop_reports_; }

 private:
  static constexpr std::int64_t kUnknown = std::numeric_limits<std::int64_t>::min();
  struct Axis {
    int number = 0;  // 0 for X, 1 for Y
    ReportField position;
    double sign = 1;         // of the force
    int block = 0;           // index of its effect
    std::int64_t level = 0;  // of the last force that got through
    Report force;
    Report start;
    bool news = false;  // its position has come since the last reading
  };

  // A bit in which a device reports its own state.
  struct StateBit {
    ReportField field;
    Usage usage = 0;
    bool well = false;
    bool was_well = false;  // at any time on this connection
  };

  int create_effect(HidTransport& transport) const;
  void make_stop_reports();
  // Reads positions. Returns which axes the report holds; nothing if it makes no sense.
  std::optional<std::array<bool, 2>> decode_positions(std::span<const std::uint8_t> report,
                                                      DeviceReading& reading) const noexcept;
  bool decode_state(std::span<const std::uint8_t> report, DeviceReading& reading) noexcept;

  PidSettings settings_;
  PidReports reports_;
  DeviceTraits traits_;
  std::vector<Axis> axes_;
  std::vector<ReportField> buttons_;
  std::vector<StateBit> state_;
  Report silent_report_;
  std::vector<Report> stop_reports_;
  nanoseconds started_{};
  bool playing_ = false;
};

}  // namespace limpid
