// Memory that stays where it is.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>

namespace limpid {

// From now on no page of the process is taken away once it has been touched, and what ticks run is
// brought in at once: the program, the C and C++ libraries, those of devices. Of the others, as
// those that draw, which are many times as large, only what is used is ever in memory. May be
// called again. False where the system forbids it; then nothing is locked.
bool lock_memory();

// Large blocks go back to the system as soon as they are freed. Else malloc learns to keep them, a
// heap for every few threads, and locked memory cannot be taken out of the middle of a heap: what
// was once needed stays for good. For programs that go on for long; before they have threads.
void give_back_what_is_freed();

// The other way round: large blocks stay, so that the next run finds memory whose pages are there
// already. For commands that do the same many times over and end.
void keep_what_is_freed();

// What the operating system grants a thread that must wake up on time.
enum class Scheduling : std::uint8_t {
  fifo,      // real-time, by the process's own right
  rtkit,     // real-time, granted on request
  ordinary,  // not real-time: threads that can wait should call yield_to_haptics()
};

struct RealtimeReport {
  Scheduling scheduling = Scheduling::ordinary;
  int priority = 0;            // real-time priority; 0 when ordinary
  bool memory_locked = false;  // no page of the process will be taken away
  std::string explanation;     // one line for people

  bool realtime() const { return scheduling != Scheduling::ordinary; }
};

// Asks somebody else to give a thread of this process a real-time priority; true if that was done.
using AskForPriority = std::function<bool(pid_t tid, int priority)>;

// Makes the calling thread as punctual as the system permits: FIFO 80, else the highest priority
// below that the process may take, else what `ask` (may be empty) obtains, else ordinary
// scheduling. Also shortens the timer slack, locks memory where that is safe and touches the
// stack, so that ticks meet no page faults.
RealtimeReport become_realtime(const AskForPriority& ask);

// Puts the calling thread, and threads it creates from now on (those of the OpenGL driver), behind
// all others, so that an ordinary haptic thread is served first. There is no way back without
// privilege: HapticThread must exist before. False if the system refused.
bool yield_to_haptics() noexcept;

}  // namespace limpid
