// Checks of this computer for Limpid. They open no device, arm nothing, change no file.
#pragma once

#include "app/doctor/finding.h"

namespace limpid {

// Checks whether a thread gets real-time priority and locked memory, and what else makes ticks
// late.
DoctorFindings look_at_real_time();
// Lists the devices, and whether this user may talk to them.
DoctorFindings look_at_devices();
// Checks whether pictures can be drawn without a display and in a window, and by what.
DoctorFindings look_at_picture();
// Checks Limpid's files, the programs that it starts, and the folders that it writes to.
DoctorFindings look_at_files();

}  // namespace limpid
