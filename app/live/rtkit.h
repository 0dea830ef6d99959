// Real-time priority for ordinary users, from RealtimeKit over D-Bus.
#pragma once

#include <sys/types.h>

#include <string>

#include "core/realtime/realtime.h"

namespace limpid {

// Asks RealtimeKit on the system bus to schedule thread `tid` of this process in real time; waits
// at most a second. False without bus or RealtimeKit, or if it refuses; `why` (may be null) then
// gets a line with the reason. The process must have limited RLIMIT_RTTIME before.
bool ask_rtkit(pid_t tid, int priority, std::string* why);

// ask_rtkit() for become_realtime(), without the reason of a refusal.
AskForPriority by_rtkit();

}  // namespace limpid
