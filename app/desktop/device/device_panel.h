// Panel of the device: which one drives the loop, its card, and what can be adjusted.
#pragma once

#include <span>

#include "app/desktop/device/device_card.h"
#include "app/desktop/device/device_controller.h"
#include "app/desktop/device/pad_hand.h"

namespace limpid {

struct PadChoice {
  const std::vector<Pad>& pads;  // plugged in
  std::string& chosen;           // the one that moves the hand; empty: the mouse alone
};

// Finished changes of a device's notes.
struct NotesEdited {
  bool anew = false;    // the device has to be connected anew
  bool limits = false;  // limits of force
};

// Draws axes, a joystick's settings, and limits of force; changes only edited values. `joints` of
// the arm, as many as `angles`; empty for a cap, which has none.
NotesEdited draw_notes(DeviceNotes& notes, std::span<const double> angles,
                       std::span<const Joint> joints, bool uncalibrated, bool limits_fixed);

DeviceCardAsks draw_device_panel(DeviceController& devices, const LiveStage& live,
                                 const PadChoice& pads, Parameters& p);

}  // namespace limpid
