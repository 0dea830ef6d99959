// Turns a wanted state, armed or not, into the force request of each tick.
#pragma once

#include "core/tick/arming.h"

namespace limpid::test {

class Wisher {
 public:
  explicit Wisher(bool armed = false) : armed_(armed) {}

  ForceRequest at(bool armed) {
    if (armed == armed_) return ForceRequest::as_it_is;
    armed_ = armed;
    return armed ? ForceRequest::arm : ForceRequest::cut;
  }

 private:
  bool armed_;
};

}  // namespace limpid::test
