// The virtual coupling by spring and damper, (1)-(2). All laws of the paper add to it.
#pragma once

#include <cmath>

#include "core/coupling/feedforward.h"
#include "core/coupling/law.h"
#include "core/coupling/link.h"
#include "core/coupling/spring_damper.h"
#include "core/touch/proxy.h"

namespace limpid {

// Steps the proxy, (4), with the springs and dampers of (2) at the midpoint. Returns the torque
// asked of the motors, (1) without the device's own damping [N m].
template <int N>
Vec<N> couple(const SpringDamper& p, const LawInput<N>& in, const Feedforward<N>& ff,
              Proxy<N>& proxy);

// The proxy's half of couple(), (2), from its side's knowledge of the device.
template <int N>
void move_proxy(const SpringDamper& p, const LawInput<N>& in, const FromDevice<N>& device,
                const Feedforward<N>& ff, Proxy<N>& proxy);
// The device's half, (1), from its side's knowledge of the proxy.
template <int N>
Vec<N> on_device(const SpringDamper& p, const LawInput<N>& in, const FromProxy<N>& proxy,
                 const Feedforward<N>& ff);
// State of each side for the other. The proxy's is the one before its step, with f2 left to fill
// in.
template <int N>
FromDevice<N> told(const LawInput<N>& in) {
  return {in.x1, in.v1, in.device, in.f1_hat, 0, 0, Vec<N>::Zero(in.x1.size())};
}
template <int N>
FromProxy<N> told(const LawInput<N>& in, const Proxy<N>& proxy) {
  const Vec<N> zero = Vec<N>::Zero(in.x1.size());
  return {proxy.x(), in.vbar2, {proxy.M(), proxy.C(), proxy.v()}, zero, 0, 0, zero};
}

// Energy of the coupling's springs k_vc, one at each joint, whose torque is at most the motors'
// [J].
template <int N>
double spring_energy(const Vec<N>& k_vc, const Vec<N>& x, const Vec<N>& limit) {
  double V = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double pull = k_vc[i] * std::abs(x[i]);
    V += pull > limit[i] ? limit[i] * std::abs(x[i]) - limit[i] * limit[i] / (2 * k_vc[i])
                         : pull * std::abs(x[i]) / 2;
  }
  return V;
}

// Energy given to bodies over the last tick [J].
template <int N>
double given_to_bodies(const Proxy<N>& proxy) {
  const BodyWorld* world = proxy.contacts().world();
  return world != nullptr ? world->given() : 0;
}

}  // namespace limpid
