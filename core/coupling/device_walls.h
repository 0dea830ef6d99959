// Walls rendered on the device itself, without a virtual mass: the proxy goes where the readings
// are, and the torque is what the walls' springs hold there.
#pragma once

#include "core/coupling/law.h"
#include "core/touch/contact_solve.h"

namespace limpid {

template <int N>
class DeviceWalls {
 public:
  // Moves the proxy to the reading over the tick, with the friction and the bodies that it meets;
  // returns what the contacts hold at the reading.
  HeldContacts<N> step(const LawInput<N>& in, Proxy<N>& proxy);
  // Number of ticks so far in which bodies stood still for want of a solution.
  int unsettled() const { return unsettled_; }

 private:
  ContactSolve<N> contacts_;
  ContactAnswer<N> prescribed_;  // the motion is given, so no response is asked for
  int unsettled_ = 0;
};

extern template class DeviceWalls<3>;
extern template class DeviceWalls<7>;
extern template class DeviceWalls<kAnyDof>;

}  // namespace limpid
