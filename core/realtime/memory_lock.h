// Memory that stays where it is.
#pragma once

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

}  // namespace limpid
