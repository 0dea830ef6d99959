// A D-Bus daemon of the test's own, which the process takes for the computer's buses.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/support/spoken_program.h"
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
    daemon_.emplace(std::vector<std::string>{"dbus-daemon", "--session", "--nofork",
                                             "--print-address=1", "--address=" + address});
  }
  bool runs() const { return daemon_->ready(); }

 private:
  std::optional<SpokenProgram> daemon_;
};

}  // namespace limpid::test
