// Panel of the device: which one drives the loop, its state, and why force is off.
#pragma once

#include <span>

#include "app/desktop/device/device_controller.h"
#include "app/desktop/device/pad_hand.h"

namespace limpid {

struct PadChoice {
  const std::vector<Pad>& pads;  // plugged in
  std::string& chosen;           // the one that leads the hand; empty: the mouse alone
};

// Returns the parameters with the predictive law's delay set to a measured one [s], in whole ticks
// up to its limit.
Parameters reckoning_with(Parameters p, double delay);

// Finished changes of a device's notes.
struct NotesEdited {
  bool anew = false;    // the device has to be connected anew
  bool limits = false;  // limits of force
};

// Draws axes, a joystick's settings, and limits of force; changes only edited values. `joints` of
// the arm, as many as `angles`; empty for a cap, which has none.
NotesEdited draw_notes(DeviceNotes& notes, std::span<const double> angles,
                       std::span<const Joint> joints, bool uncalibrated, bool limits_fixed);

// Label of the button that begins the check of a device's axes.
inline constexpr const char* kCheckAxes = "Check the axes";

// Labels of the buttons that say which arm a device is.
inline constexpr const char* kBuiltInArmButton = "the built-in one";
inline constexpr const char* kOpenArmButton = "the open one";
inline constexpr const char* kArmOfFileButton = "a file...";

// Requests made in the panel.
struct DevicePanelAsks {
  bool identify = false;
  bool arm_file = false;  // asks for the file of the device's arm
};
DevicePanelAsks draw_device_panel(DeviceController& devices, const LiveStage& live,
                                  const PadChoice& pads, Parameters& p);

}  // namespace limpid
