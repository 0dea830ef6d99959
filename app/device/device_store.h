// Notes on each device between two starts, and the one in use.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/tick/compensation.h"
#include "core/tick/safety_limits.h"
#include "devices/adjusted_device.h"
#include "devices/hid/axis_check.h"
#include "devices/hid/pid_joystick.h"

namespace limpid {

inline constexpr double kLeastTorqueScale = 0.1, kMostTorqueScale = 10;

// Forces of the device that its motors compensate, and its direction down.
struct OwnForces : CompensationSettings {
  Down down = Down::as_file;

  static OwnForces of(const Parameters& p) {
    const CompensationSettings& compensation = p;
    return {compensation, p.down};
  }
  void give(Parameters& p) const {
    const CompensationSettings& compensation = *this;
    static_cast<CompensationSettings&>(p) = compensation;
    p.down = down;
  }
  friend bool operator==(const OwnForces&, const OwnForces&) = default;
};

inline constexpr const char* kBuiltInArm = "built-in";

struct DeviceNotes {
  std::vector<AxisAdjustment> axes;  // of its joints; missing ones are unadjusted
  PidSettings pid;                   // of a joystick: its range and its effort
  SafetyLimits limits;               // of its force; no higher than usual
  bool checked = false;              // its motors were seen to move its axes as commanded
  std::string checked_as;            // what_it_is() at the check; empty: not noted
  std::string arm;                   // URDF of the identified arm; empty: not identified
  // Arm chosen by a person, kBuiltInArm or a URDF, and the tip in it; empty: none.
  std::string taken_for, taken_for_tip;
  std::string taken_as;  // what_it_is() at the choice; empty: the device was not there
  // Found at the identification, from a reading to its torque, beyond the tick [s]; NaN: not known.
  double delay = std::numeric_limits<double>::quiet_NaN();
  double torque_scale = 1;  // real over commanded torque of its motors
  OwnForces compensation;   // while it is in the loop
  std::string refusal;      // why its entry cannot be understood; it is then not used
};

// Fields of a device's entry. Beside them it has `reverse`, `axis`, `limits` and `compensation`.
inline constexpr std::array kNotesFields{
    Field<DeviceNotes>("checked", "axes checked", &DeviceNotes::checked, {0, 1}, ""),
    Field<DeviceNotes>("checked_as", "checked as", &DeviceNotes::checked_as, {}, ""),
    Field<DeviceNotes>("arm", "arm", &DeviceNotes::arm, {}, ""),
    Field<DeviceNotes>("taken_for", "taken for", &DeviceNotes::taken_for, {}, ""),
    Field<DeviceNotes>("taken_for_tip", "its tip", &DeviceNotes::taken_for_tip, {}, ""),
    Field<DeviceNotes>("taken_as", "taken as", &DeviceNotes::taken_as, {}, ""),
    Field<DeviceNotes>("delay", "delay", &DeviceNotes::delay, {0, 1, false, "s"}, ""),
    Field<DeviceNotes>("torque_scale", "torque scale", &DeviceNotes::torque_scale,
                       {kLeastTorqueScale, kMostTorqueScale}, ""),
};
inline constexpr std::array kPidFields{
    Field<PidSettings>("range", "range", &PidSettings::range, {0.01, 3.2, false, "rad"},
                       "Largest angle of the stick to each side.", {0.0873, 1.047}),
    Field<PidSettings>(
        "effort", "full force", &PidSettings::effort, {0.01, 50, false, "N m"},
        "The joystick's torque at full force, measured or from the data sheet: USB gives forces "
        "without a unit. If this value is too low, the joystick pushes too hard.",
        {0.05, 10, true}),
};
inline constexpr std::array kAxisFields{
    Field<AxisAdjustment>("zero", "zero", &AxisAdjustment::zero, {-100, 100, false, "rad"}, ""),
    Field<AxisAdjustment>("scale", "scale", &AxisAdjustment::scale, {0.1, 10},
                          "Joint angle divided by the angle of the device. Torques are scaled as "
                          "well, so that the power at the hand equals the power in the loop.",
                          {0.1, 10, true}),
    Field<AxisAdjustment>("inverted", "invert", &AxisAdjustment::inverted, {0, 1},
                          "Reverses the sign of the axis and of its torque."),
};
// The settings of the same names, without their tables.
inline constexpr auto kOwnForcesFields = [] {
  auto fields =
      joined<OwnForces>(CompensationSettings::settings<OwnForces>(),
                        std::array{Field<OwnForces>("device.down", "Down, in the base's frame",
                                                    choice<OwnForces, &OwnForces::down>(kDowns),
                                                    {0, kDowns.size() - 1}, "")});
  for (auto& field : fields) field.key += std::string_view(field.key).find('.') + 1;
  return fields;
}();

// Description of a device without a serial number; tells another one in its place from the device
// that was checked.
std::string what_it_is(const std::string& name, int dof);

// Notes a check that has passed: adjusts the axes, and reverses the torques of reversed joints.
// False, and nothing changes, if it has not passed.
bool remember_check(const AxisCheck& check, DeviceNotes& notes);

// Limits in TOML, as recordings keep them.
std::string limits_text(const SafetyLimits& limits);

struct DeviceStore {
  std::string in_use;  // id of the device; empty: the virtual arm
  std::map<std::string, DeviceNotes> notes;
  std::string refusal;  // why the file cannot be understood; no device that can push is then used

  std::string complaint() const;  // all that cannot be understood, a line each; empty: nothing
};

// $XDG_CONFIG_HOME/limpid/devices.toml.
std::filesystem::path device_store_file();

// Reads the store; empty if there is no file.
DeviceStore load_device_store(const std::filesystem::path& file);
// Writes the changes since `before` into the present file. Keeps changes by other programs, and
// unknown keys that are no tables and name no limit. Writes nothing over entries that cannot be
// understood. Returns the error; empty: none.
std::string save_device_store(const DeviceStore& before, const DeviceStore& now,
                              const std::filesystem::path& file);

}  // namespace limpid
