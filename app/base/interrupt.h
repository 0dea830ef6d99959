// Ctrl-C, termination and a terminal that is closed as a wish that running work looks at.
#pragma once

#include <atomic>
#include <csignal>

namespace limpid {

// A signal can only reach something with a fixed address.
inline std::atomic<bool> interrupted{false};

// From now on SIGINT, SIGTERM and SIGHUP set `interrupted` instead of ending the program; one that
// whoever started it wants to be ignored, as nohup does, stays so.
inline void catch_interrupts() {
  const auto note = [](int) { interrupted.store(true); };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, note) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace limpid
