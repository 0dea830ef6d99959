// What is wrong with a HID device, in one line for people.
#pragma once

#include <stdexcept>

namespace limpid {

struct HidError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace limpid
