// What a coupling law is: how it ties device and proxy together for a tick, its settings, and what
// people are told of it. Each law is one file; laws.h lists them.
#pragma once

#include <span>

#include "core/coupling/decomposition.h"

namespace limpid {

template <int N>
class Proxy;

// What people read about a law, and what it uses.
struct LawInfo {
  const char* key;      // in files and on the command line
  const char* label;    // on a button
  const char* meaning;  // in help and tooltips, a sentence after "KEY: "
  // It feeds the observed human force forward, and scales the inertia felt by eta, (12): then the
  // conditions of (25) are its own.
  bool scales_inertia;
  std::span<const char* const> sliders;  // keys, in the panel
};

// What a law knows at t_k.
template <int N>
struct LawInput {
  const Vec<N>& x1;           // of the device, as measured [rad]
  const Vec<N>& v1;           // (x1_k - x1_k-1) / T [rad/s]
  const Dynamics<N>& device;  // M1, C1 as the controller believes them, and the velocity's estimate
  const Vec<N>& f1_hat;       // human torque, as observed [N m]
  const Vec<N>& vbar2;        // mean velocity of the proxy over the tick before [rad/s]
  double T;                   // of the tick that begins [s]
};

}  // namespace limpid
