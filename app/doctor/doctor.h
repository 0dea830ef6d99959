// Looks at this computer as Limpid needs it. Opens no device, arms nothing, changes no file.
#pragma once

#include "app/doctor/finding.h"

namespace limpid {

// Whether a thread gets real-time priority and memory that stays, and what else makes ticks late.
DoctorFindings look_at_real_time();
// What is plugged in, and whether this user may talk to it.
DoctorFindings look_at_devices();
// Whether pictures can be drawn without a display and in a window, and by what.
DoctorFindings look_at_picture();
// What belongs to Limpid, what it starts, and where it writes.
DoctorFindings look_at_files();

}  // namespace limpid
