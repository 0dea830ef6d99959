// A D-Bus daemon of the test's own, which the process takes for the computer's buses.
#pragma once

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "tests/support/temp_dir.h"

namespace limpid::test {

// All buses of a process have one address, one after the other: D-Bus' library reads the addresses
// of both buses with the first connection.
class PrivateBus {
 public:
  PrivateBus() {
    static const TempDir dir;
    const std::string address = "unix:path=" + (dir / "bus").string();
    for (const char* bus : {"DBUS_SYSTEM_BUS_ADDRESS", "DBUS_SESSION_BUS_ADDRESS"}) {
      setenv(bus, address.c_str(), 1);
    }
    std::error_code none;
    std::filesystem::remove(dir / "bus", none);
    const std::string option = "--address=" + address;
    const std::array arguments{"dbus-daemon",  "--session",
                               "--nofork",     "--print-address=1",
                               option.c_str(), static_cast<const char*>(nullptr)};
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    if (posix_spawnp(&pid_, arguments[0], &actions, nullptr,
                     const_cast<char* const*>(arguments.data()), environ) != 0) {
      pid_ = -1;
    }
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::array<char, 512> line{};  // the bus listens once it has printed its address
    const ssize_t length = read(ends[0], line.data(), line.size());
    close(ends[0]);
    runs_ = length > 0 && std::ranges::find(line, '\n') != line.end();
  }
  ~PrivateBus() {
    if (pid_ < 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  PrivateBus(const PrivateBus&) = delete;
  PrivateBus& operator=(const PrivateBus&) = delete;
  bool runs() const { return runs_; }

 private:
  pid_t pid_ = -1;
  bool runs_ = false;
};

}  // namespace limpid::test
