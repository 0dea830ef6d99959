// Interruption by Ctrl-C, termination or a closed terminal, as a wish that running work looks at.
#pragma once

#include <atomic>
#include <csignal>

namespace limpid {

// Wish to stop; at a fixed address, as a signal can reach nothing else.
inline std::atomic<bool> interrupted{false};

// Makes SIGINT, SIGTERM and SIGHUP set `interrupted` from now on instead of ending the program. A
// signal that was ignored from the start, as by nohup, stays so.
inline void catch_interrupts() {
  const auto note = [](int) { interrupted.store(true); };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace limpid
