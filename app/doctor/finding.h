// A finding about this computer, with its remedy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace limpid {

struct Finding {
  enum class State : std::uint8_t {
    fine,
    better,  // all works; something would be better
    broken,  // something of Limpid does not work here
  };

  std::string area;  // "real time", "devices", "picture", "files"
  std::string what;  // the thing looked at
  State state = State::fine;
  std::string found;
  std::string cost;  // consequence; empty if all is fine
  std::string mend;  // a command, or advice; empty if all is fine
};
using DoctorFindings = std::vector<Finding>;

}  // namespace limpid
