// The panel of the device: which one drives the loop, what it says, why force is off.
#pragma once

#include "app/desktop/desk/device_desk.h"

namespace limpid {

void draw_device_panel(DeviceDesk& devices, const Desk& desk);

}  // namespace limpid
