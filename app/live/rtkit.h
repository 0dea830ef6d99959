// Real-time priority for ordinary users, from RealtimeKit over D-Bus.
#pragma once

#include <sys/types.h>

#include <string>

#include "core/realtime/realtime.h"

namespace limpid {

// Asks RealtimeKit on the system bus to schedule thread `tid` of this process in real time. Waits a
// second for the answer at most. False when there is no bus, no RealtimeKit or it refuses; `why`
// (may be null) then gets one line saying so. The process must have limited RLIMIT_RTTIME before.
bool ask_rtkit(pid_t tid, int priority, std::string* why);

// The same for become_realtime(), without a word of why not.
AskForPriority by_rtkit();

}  // namespace limpid
