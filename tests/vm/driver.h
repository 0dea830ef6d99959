// Another process that drives the device: this program with the device's kind as its argument.
#pragma once

#include <spawn.h>
#include <unistd.h>

#include <string>

#include "devices/hid/device_list.h"

namespace limpid::test {

inline pid_t start_driver(HidKind kind) {
  std::string program = "/proc/self/exe";
  std::string word = kind == HidKind::raw ? "drive-raw" : "drive-pid";
  char* arguments[] = {program.data(), word.data(), nullptr};
  pid_t child = 0;
  return posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0 ? child
                                                                                         : -1;
}

}  // namespace limpid::test
