// Check whether the program at the other end of standard input is still there.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <array>

namespace limpid {

// Returns true once standard input has ended; drops what comes through it.
inline bool input_has_ended() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (poll(&input, 1, 0) <= 0) return false;
  std::array<char, 256> bytes{};
  return ::read(STDIN_FILENO, bytes.data(), bytes.size()) <= 0;
}

}  // namespace limpid
