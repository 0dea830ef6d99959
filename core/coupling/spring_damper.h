// Settings of spring, damper and link between device and proxy, and condition (3) on them.
#pragma once

#include <array>
#include <span>

#include "core/base/field.h"

namespace limpid {

struct SpringDamper {
  double k_vc = 10;        // [N m/rad]
  double b_vc = 0.001;     // [N m s/rad]
  double b_v = 0.012;      // [N m s/rad]
  bool per_joint = false;  // see gain_weights()

  template <class P>
  static constexpr std::array<Field<P>, 4> settings() {
    return {{{"coupling.k_vc", "k_vc", "Coupling spring k_vc", &P::k_vc, "N m/rad", 1e-3, 1e4, 0.1,
              100, true, true,
              "Spring between device and proxy, equations (1)-(2). A stiffer spring keeps both "
              "closer together. It must not break condition (3): b_d >= 2 b_vc + k_vc T and b_v >= "
              "k_vc T / 2."},
             {"coupling.b_vc", "b_vc", "Coupling damper b_vc", &P::b_vc, "N m s/rad", 0, 100, 1e-5,
              0.1, true, true,
              "Damper between device and proxy, equations (1)-(2). The damper acts on a delayed "
              "velocity, so by condition (3) the device needs twice this damping."},
             {"coupling.b_v", "b_v", "Proxy damper b_v", &P::b_v, "N m s/rad", 0, 100, 1e-4, 1,
              true, true,
              "Damping of the proxy, equation (2). The hand feels this damping through the "
              "coupling. Condition (3): b_v must be at least k_vc T / 2, where k_vc is the "
              "coupling spring and T the tick."},
             {"coupling.per_joint", "gains per joint", "Gains grow with each joint's damping",
              &P::per_joint, "-", 0, 1, 0, 1, false, true,
              "k_vc, b_vc and b_v are the gains of the joint with the least damping b_d. The other "
              "joints have gains that are larger in the same proportion as their damping, so all "
              "joints meet condition (3) alike. Off: all joints have the same gains, as under wave "
              "and tdpn in any case."}}};
  }
};

// Factors of k_vc, b_vc and b_v at each joint [-]. b_d: of every joint [N m s/rad].
template <class V>
V gain_weights(const SpringDamper& p, const V& b_d) {
  const double least = p.per_joint ? b_d.minCoeff() : 0;
  if (!(least > 0)) return V::Ones(b_d.size());
  return b_d / least;
}

// The spring k_vc at each joint [N m/rad].
template <class V>
V springs(const SpringDamper& p, const V& b_d) {
  return p.k_vc * gain_weights(p, b_d);
}

inline constexpr int kMostLinkDelay = 200, kMostLinkJitter = 50;  // [ticks]

// A delay between device and proxy, see link.h.
struct LinkSettings {
  int link_delay = 0;    // delay each way [ticks]
  int link_jitter = 0;   // largest extra delay of a packet [ticks]
  double link_loss = 0;  // share of the packets that never arrive [-]
  int link_seed = 1;     // seed of the random numbers for jitter and loss

  bool linked() const { return link_delay > 0 || link_jitter > 0 || link_loss > 0; }
  // Largest age of a side's knowledge of the other, unless packets are lost [ticks].
  int oldest() const { return link_delay + link_jitter; }

  template <class P>
  static constexpr std::array<Field<P>, 4> settings() {
    return {
        {{"link.delay", "link delay", "Link delay, each way", &P::link_delay, "ticks", 0,
          kMostLinkDelay, 0, 100, false, true,
          "Delay between device and proxy in each direction, as if the world were far away. The "
          "predictive coupling solves device and proxy together and has no link."},
         {"link.jitter", "link jitter", "Link jitter", &P::link_jitter, "ticks", 0, kMostLinkJitter,
          0, 20, false, true,
          "Each packet between device and proxy takes up to this many ticks more, at random. "
          "Device and proxy use the newest packet that has arrived."},
         {"link.loss", "link loss", "Packets lost", &P::link_loss, "-", 0, 0.9, 0, 0.5, false, true,
          "Share of the packets between device and proxy that never arrive. A side without a new "
          "packet keeps using its last packet."},
         {"link.seed", "link seed", "link seed", &P::link_seed, "-", 0, 1e9, 0, 100, false, true,
          "Seed of the random numbers for link.jitter and link.loss, a whole number. The same "
          "seed gives the same numbers."}}};
  }
};

// Condition (3) for a constant tick: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2. With a torque
// that answers its reading t_d late, and knowledge of the other side up to t_l old, j ticks of it
// jitter,
//     b_d >= (2 + j/2) b_vc + k_vc (T + 3/2 t_d + t_l),
//     b_v >= j/2 b_vc + k_vc ((T + t_d) / 2 + t_l).
//
// With a delay of d ticks the device's torque lacks k_vc (x_E,k - x_E,k-d), whose work on dx1_k is
// at most
//     k_vc sum_j |dx1_k (dx1_k-j - dx2_k-j)| <= k_vc d (3/2 dx1^2 + 1/2 dx2^2),
// summed over the ticks; the dampers b_d, b_v take b/T dx^2. The bound of (3) itself is derived in
// the same way. Through a link the device lacks k_vc (x2_k - x2_k-d) and the proxy k_vc (x1_k -
// x1_k-d), together at most k_vc d (dx1^2 + dx2^2). For d ticks each way this agrees with Lee and
// Spong (2006) and Nuno et al. (2009) for such couplings in continuous time. Velocities that are
// held for want of newer ones act up to j + 1 times.
//
// With gain_weights() the condition is the same for every joint.
//
// The condition covers spring and damper alone: no limit is known for torques that the proposed law
// feeds forward through a link.
struct Condition3 {
  double device_margin = 0;  // b_d less the bound, at the joint with the least [N m s/rad]
  double proxy_margin = 0;   // b_v less the bound [N m s/rad]
  bool known = true;         // false where packets are lost: then their age has no bound
  bool holds = false;        // to round-off: the paper's own gains are on the edge
};
// Evaluates the condition. b_d: of every joint [N m s/rad]; T and delay [s].
Condition3 condition3(const SpringDamper& p, double T, std::span<const double> b_d,
                      double delay = 0, const LinkSettings& link = {});

}  // namespace limpid
