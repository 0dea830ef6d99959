// Ctrl-C and termination as a wish that running work looks at.
#pragma once

#include <atomic>
#include <csignal>

namespace limpid {

// A signal can only reach something with a fixed address.
inline std::atomic<bool> interrupted{false};

// From now on SIGINT and SIGTERM set `interrupted` instead of ending the program.
inline void catch_interrupts() {
  const auto note = [](int) { interrupted.store(true); };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

}  // namespace limpid
