// The panel of the device: which one drives the loop, what it says, why force is off.
#pragma once

#include <span>

#include "app/desktop/live/device_controller.h"
#include "app/desktop/live/pad_hand.h"

namespace limpid {

struct PadChoice {
  const std::vector<Pad>& pads;  // that are plugged in
  std::string& chosen;           // the one that leads the hand; empty: the mouse alone
};

// The predictive law then reckons with a delay [s] that was measured, in whole ticks, as many as it
// can.
Parameters reckoning_with(Parameters p, double delay);

// Changes of a device's notes that a person has finished.
struct NotesEdited {
  bool anew = false;    // the device has to be connected anew for it
  bool limits = false;  // of its force
};

// Axes, a joystick's settings, and limits of force. Changes what somebody edits, and nothing that
// is only shown. `joints`: of the arm, as many as `angles`; empty: a cap, which has none.
NotesEdited draw_notes(DeviceNotes& notes, std::span<const double> angles,
                       std::span<const Joint> joints, bool uncalibrated, bool limits_fixed);

// The button that begins the check of a device's axes.
inline constexpr const char* kCheckAxes = "Check the axes";

// The buttons of the question which arm a device is.
inline constexpr const char* kBuiltInArmButton = "the built-in one";
inline constexpr const char* kOpenArmButton = "the open one";
inline constexpr const char* kArmOfFileButton = "a file...";

// Requests that a person has made in the panel.
struct DevicePanelAsks {
  bool identify = false;
  bool arm_file = false;  // for the file of the device's arm
};
DevicePanelAsks draw_device_panel(DeviceController& devices, const LiveSession& live,
                                  const PadChoice& pads, Parameters& p);

}  // namespace limpid
