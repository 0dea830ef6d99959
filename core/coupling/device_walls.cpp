#include "core/coupling/device_walls.h"

#include "core/touch/proxy.h"

namespace limpid {
namespace {

constexpr int kMostTurns = 16;       // turns between bodies and the walls' forces
constexpr double kSameForce = 1e-5;  // change of force at which the turns end [N]

}  // namespace

template <int N>
HeldContacts<N> DeviceWalls<N>::step(const LawInput<N>& in, Proxy<N>& proxy) {
  const double T = in.T;
  const Vec<N> u = (in.x1 - proxy.x()) / T;
  proxy.look(T);
  contacts_.collect(proxy.contacts(), proxy.arm(), proxy.frames(), u, T);
  contacts_.prepare(prescribed_, T);
  Vec<N> f2 = contacts_.push(u, T, nullptr);
  bool settled = false;
  for (int turn = 0; !settled && turn < kMostTurns; ++turn) {
    settled = contacts_.push_bodies(turn) < kSameForce;
    if (!settled) f2 = contacts_.push(u, T, nullptr);
  }
  if (!settled) {
    contacts_.hold_bodies();
    f2 = contacts_.push(u, T, nullptr);
    ++unsettled_;
  }
  const HeldContacts<N> held = contacts_.held(u, T);
  contacts_.finish(proxy.contacts());
  proxy.carry(T, u, f2);
  return held;
}

template class DeviceWalls<3>;
template class DeviceWalls<7>;
template class DeviceWalls<kAnyDof>;

}  // namespace limpid
