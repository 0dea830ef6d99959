// Reports by which a USB PID device is told to push (USB Device Class Definition for PID 1.0).
#pragma once

#include <optional>
#include <vector>

#include "devices/hid/hid_protocol.h"
#include "devices/hid/report_descriptor.h"

namespace limpid {

// Usages of the Physical Interface Device page.
namespace pid {

constexpr Usage pid_usage(std::uint16_t id) { return make_usage(0x0F, id); }

inline constexpr Usage kSetEffect = pid_usage(0x21);
inline constexpr Usage kBlockIndex = pid_usage(0x22);
inline constexpr Usage kEffectType = pid_usage(0x25);
inline constexpr Usage kTypeConstantForce = pid_usage(0x26);
inline constexpr Usage kDuration = pid_usage(0x50);
inline constexpr Usage kGain = pid_usage(0x52);
inline constexpr Usage kAxesEnable = pid_usage(0x55);
inline constexpr Usage kDirectionEnable = pid_usage(0x56);
inline constexpr Usage kDirection = pid_usage(0x57);

inline constexpr Usage kSetConstantForce = pid_usage(0x73);
inline constexpr Usage kMagnitude = pid_usage(0x70);

inline constexpr Usage kEffectOperation = pid_usage(0x77);
inline constexpr Usage kEffectStart = pid_usage(0x79);
inline constexpr Usage kEffectStop = pid_usage(0x7B);
inline constexpr Usage kLoopCount = pid_usage(0x7C);

inline constexpr Usage kDeviceGainReport = pid_usage(0x7D);
inline constexpr Usage kDeviceGain = pid_usage(0x7E);

inline constexpr Usage kBlockLoad = pid_usage(0x89);
inline constexpr Usage kLoadSuccess = pid_usage(0x8C);
inline constexpr Usage kLoadFull = pid_usage(0x8D);
inline constexpr Usage kLoadError = pid_usage(0x8E);
inline constexpr Usage kBlockFree = pid_usage(0x90);
inline constexpr Usage kCreateNewEffect = pid_usage(0xAB);

inline constexpr Usage kDeviceControl = pid_usage(0x96);
inline constexpr Usage kEnableActuators = pid_usage(0x97);
inline constexpr Usage kDisableActuators = pid_usage(0x98);
inline constexpr Usage kStopAllEffects = pid_usage(0x99);
inline constexpr Usage kDeviceReset = pid_usage(0x9A);
inline constexpr Usage kDeviceContinue = pid_usage(0x9C);

inline constexpr Usage kState = pid_usage(0x92);
inline constexpr Usage kDevicePaused = pid_usage(0x9F);
inline constexpr Usage kActuatorsEnabled = pid_usage(0xA0);
inline constexpr Usage kSafetySwitch = pid_usage(0xA4);
inline constexpr Usage kActuatorPower = pid_usage(0xA6);

}  // namespace pid

// Fills in reports as the device's descriptor says.
//
// PID knows no N m and no fixed bytes: every device chooses its report ids, field sizes and ranges.
class PidReports {
 public:
  // Throws HidError naming what the device lacks.
  explicit PidReports(ReportDescriptor descriptor);

  // A usage of the Device Control collection; nothing if the device does not know it.
  std::optional<Report> device_control(Usage what) const;
  // Sets the strength of all effects to its maximum; nothing if it cannot be set.
  std::optional<Report> full_gain() const;

  // Feature reports: create_constant_force() asks for room for a constant force; block_load(), with
  // its id alone, asks for the result.
  Report create_constant_force() const;
  Report block_load() const;
  // The index of the new effect in the filled block load report; nothing if it is not ready. Throws
  // HidError if the device has no room or refuses.
  std::optional<int> created(std::span<const std::uint8_t> block_load) const;

  // Sets up an effect. `axis`: 0 for X, 1 for Y; `duration` [s] after each start.
  Report set_effect(int block, int axis, double duration) const;
  // The force report of an effect, 0 at first.
  Report constant_force(int block) const;
  // The level for a strength of -1..1 of full force, positive towards positive X or Y; equal levels
  // are equal forces.
  std::int64_t force_level(int axis, double strength) const noexcept;
  void set_force(Report& constant_force, std::int64_t level) const noexcept;
  Report start(int block) const { return operation(block, true); }
  Report stop(int block) const { return operation(block, false); }
  std::optional<Report> block_free(int block) const;

  // Returns whether the device can push along this axis.
  bool drives(int axis) const;

 private:
  const ReportField& need(ReportKind kind, Usage usage, Usage within, const char* name) const;
  Report blank(const ReportField& field) const;
  Report operation(int block, bool start) const;
  void set_direction(Report& report, int axis) const;
  bool is_direction(const ReportField& field) const;
  bool by_angle() const;            // effects have an angle from which they push
  bool names_axis(int axis) const;  // effects can be enabled for this axis
  bool names_axes() const;          // effects can be enabled for any axis

  ReportDescriptor descriptor_;
  ReportField magnitude_;
  bool by_angle_ = false;
};

}  // namespace limpid
