// Starts another process that drives the device: this program with the device's name as its
// argument.
#pragma once

#include <spawn.h>
#include <unistd.h>

#include <string>
#include <utility>

namespace limpid::test {

// Starts the driver; `name` is kName of the device's model.
inline pid_t start_driver(std::string name) {
  std::string program = "/proc/self/exe";
  std::string word = "drive-" + std::move(name);
  char* arguments[] = {program.data(), word.data(), nullptr};
  pid_t child = 0;
  return posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0 ? child
                                                                                         : -1;
}

}  // namespace limpid::test
