// Real-time scheduling of the calling thread: priority, locked memory, timer slack.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>

namespace limpid {

// Locks the process's memory: from now on no page is taken away once it has been touched. Loads at
// once the code that ticks run: the program, the C and C++ libraries, those of devices. Other
// libraries, such as those that draw, are many times as large and are loaded page by page when
// used. May be called again. False where the system forbids it; then nothing is locked.
bool lock_memory();

// Makes malloc return large blocks to the system as soon as they are freed. By default it learns to
// keep them, in one heap for every few threads, and locked memory inside a heap cannot be returned.
// For programs that run for long; to be called before they have threads.
void give_back_what_is_freed();

// Makes malloc keep large blocks, so that the next run finds memory whose pages are there already.
// For commands that do the same many times over and end.
void keep_what_is_freed();

// Scheduling that the operating system grants to a thread.
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

// Asks another process to give a thread of this one a real-time priority; true if that was done.
using AskForPriority = std::function<bool(pid_t tid, int priority)>;

// Makes the calling thread as punctual as the system permits: FIFO 80, else the highest priority
// below that the process may take, else what `ask` (may be empty) obtains, else ordinary
// scheduling. Also shortens the timer slack, locks memory where that is safe and touches the
// stack, so that ticks meet no page faults.
RealtimeReport become_realtime(const AskForPriority& ask);

// Puts the calling thread, and threads it creates from now on (those of the OpenGL driver), behind
// all others. So an ordinary haptic thread is served first. Only privilege can undo this:
// HapticThread must exist before. False if the system refused.
bool yield_to_haptics() noexcept;

}  // namespace limpid
