#include "app/cli/prompt.h"

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "app/cli/options.h"

namespace limpid {
namespace {

bool line_typed() {
  pollfd in{STDIN_FILENO, POLLIN, 0};
  if (poll(&in, 1, 0) <= 0) return false;
  std::string line;
  if (!std::getline(std::cin, line)) throw UsageError("not begun");
  return true;
}

}  // namespace

bool await_enter(const std::string& prompt, const std::function<bool()>& meanwhile) {
  tcflush(STDIN_FILENO, TCIFLUSH);
  fmt::print("{}", prompt);
  std::fflush(stdout);
  while (!line_typed()) {
    if (!meanwhile()) return false;
  }
  return true;
}

}  // namespace limpid
