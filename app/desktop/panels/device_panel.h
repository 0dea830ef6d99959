// The panel of the device: which one drives the loop, what it says, why force is off.
#pragma once

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

// The button that begins the check of a device's axes.
inline constexpr const char* kCheckAxes = "Check the axes";

// True once the device is to be identified.
bool draw_device_panel(DeviceController& devices, const LiveSession& live, const PadChoice& pads,
                       Parameters& p);

}  // namespace limpid
