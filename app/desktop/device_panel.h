// The panel of the device: which one drives the loop, what it says, why force is off.
#pragma once

namespace limpid {

class Workbench;

void draw_device_panel(Workbench& bench);

}  // namespace limpid
