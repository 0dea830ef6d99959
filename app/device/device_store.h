// What is remembered of each device between two starts: which one is in use, and how its axes are
// to be taken.
#pragma once

#include <filesystem>
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

// What the motors take of a device's own forces, and where down is for it.
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
  std::vector<AxisAdjustment> axes;  // of its joints; fewer: as they are
  PidSettings pid;                   // of a joystick: its range and its effort
  SafetyLimits limits;               // of its force; lower than usual
  bool checked = false;              // its motors were seen to move its axes as they are told
  std::string checked_as;            // what_it_is() then; empty: nobody has noted it
  std::string arm;                   // URDF of what it was identified as; empty: it was not
  // Which arm somebody has said that it is, kBuiltInArm or a URDF, and the tip in it; empty: nobody
  // has said.
  std::string taken_for, taken_for_tip;
  std::string taken_as;  // what_it_is() then; empty: it was not there
  double delay = -1;  // then found, from a reading to the torque that answers it, beyond the tick
                      // [s]; below 0: not known
  double torque_scale = 1;  // what its motors give of what they are told
  OwnForces compensation;   // while it is in the loop
  std::string refusal;  // why what the file says of it cannot be understood; it is not used then
};

// What a device without a serial number says of itself, so that another one in its place is no
// device that was checked.
std::string what_it_is(const std::string& name, int dof);

// Takes in what a check that is done has found of the device with the adjustments noted here; the
// torques of its reversed joints are turned round. False, and nothing is changed, if it has not
// passed.
bool remember_check(const AxisCheck& check, DeviceNotes& notes);

// As a recording keeps them (TOML).
std::string limits_text(const SafetyLimits& limits);

struct DeviceStore {
  std::string in_use;  // id of the device; empty: the virtual arm
  std::map<std::string, DeviceNotes> notes;
  std::string refusal;  // why nothing in the file can be understood; no device that can push is
                        // used then

  std::string complaint() const;  // all that cannot be understood, a line each; empty: nothing
};

// $XDG_CONFIG_HOME/limpid/devices.toml.
std::filesystem::path device_store_file();

// An absent file is an empty store.
DeviceStore load_device_store(const std::filesystem::path& file);
// Writes what has changed since `before` into what the file says by now: what other programs have
// written meanwhile stays, and so do keys that nobody knows. Nothing is written over that cannot be
// understood. Returns what went wrong, empty if nothing did.
std::string save_device_store(const DeviceStore& before, const DeviceStore& now,
                              const std::filesystem::path& file);

}  // namespace limpid
