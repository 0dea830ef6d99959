// How a coupling law ties device and proxy together for a tick: what it is given, and what it tells
// of itself. Each law is one file; laws.h lists them with their settings.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/coupling/decomposition.h"
#include "core/dynamics/arm.h"

namespace limpid {

template <int N>
class Proxy;
template <int N>
class ProxyLink;

// Where a law begins: device and proxy as they are.
template <int N>
struct LawStart {
  const Vec<N>& x1;      // as measured [rad]
  const Vec<N>& v1;      // [rad/s]
  const Vec<N>& f1_hat;  // human torque, as far as it is known [N m]
  // Energy that the human may still be given [J]; none: as it was left in the loop so far.
  std::optional<double> reserve{};
};

// What the device says at t_k.
template <int N>
struct LawReading {
  const Vec<N>& x1;     // as measured [rad]
  const Vec<N>& v1;     // estimated velocity [rad/s]
  double elapsed;       // since the reading before; 0 for the first one [s]
  double encoder_step;  // [rad]
};

// Where a law takes the device to be.
template <int N>
struct DeviceEstimate {
  Vec<N> x, v;  // [rad, rad/s]
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
  // For laws that model the device:
  const typename Arm<N>::Frames& frames;  // of it, where the law takes it to be
  const Vec<N>& b_d;                      // its own damping [N m s/rad]
  const Vec<N>& b_d_sure;                 // no more than that for sure
  const Vec<N>& limit;                    // of its motors [N m]
  double authority;                       // share of a torque that leaves for them, 0 to 1
  double tick;                            // as it should be [s]
  double encoder_step;                    // [rad]
  int delay_most;                         // between command and motor, at most [ticks]
  ProxyLink<N>* link = nullptr;           // between device and proxy; null: none
  bool armed_anew = false;                // somebody has just asked for force, which was off
  // The largest force that the motors may make at the tip, beside `limit` [N].
  double tip_force = std::numeric_limits<double>::infinity();
};

// How a law found the motion of a tick.
enum class TickSolve : std::uint8_t {
  usual,
  limited,     // with the motors' limits, contacts and all in one
  together,    // contacts in one, as they did not settle one after the other
  stood_still  // not at all: the proxy stays where it is for the tick, which takes energy only
};

// What a law tells of itself, a tick.
struct LawReport {
  // Energy left in its ledger; infinite without one, and before its first tick [J].
  double reserve = std::numeric_limits<double>::infinity();
  double contact_governor = 1;  // share of the contact force that it lets through
  double damping_governor = 1;  // share of the damping that it may cancel
  double torque_governor = 1;   // share of all torque that leaves
  TickSolve solved = TickSolve::usual;
  int unsettled = 0;  // ticks so far in which the proxy stood still for want of a solution
};

// What most laws need not do.
template <int N>
struct PlainLaw {
  void start(const LawStart<N>&) {}
  template <class P>
  DeviceEstimate<N> locate(const P&, const LawReading<N>& in) {
    return {in.x1, in.v1};
  }
  // The torque that really left, for the tick that begins [N m].
  void applied(const Vec<N>&) {}
  LawReport report() const { return {}; }
};

}  // namespace limpid
