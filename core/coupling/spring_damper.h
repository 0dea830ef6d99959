// The virtual coupling by spring and damper, (1)-(2), and its condition (3). All laws of the paper
// add to it.
#pragma once

#include <array>
#include <span>

#include "core/coupling/law.h"
#include "core/coupling/setting.h"
#include "core/touch/contacts.h"

namespace limpid {

struct SpringDamper {
  double k_vc = 10;     // [N m/rad]
  double b_vc = 0.001;  // [N m s/rad]
  double b_v = 0.012;   // [N m s/rad]

  template <class P>
  static constexpr std::array<Setting<P>, 3> settings() {
    return {{{"coupling.k_vc", "k_vc", &P::k_vc, "N m/rad", 1e-3, 1e4, 0.1, 100, true, true,
              "Spring between device and proxy, (1)-(2). Stiffer keeps them closer, until "
              "condition (3) breaks: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2."},
             {"coupling.b_vc", "b_vc", &P::b_vc, "N m s/rad", 0, 100, 1e-5, 0.1, true, true,
              "Damper between device and proxy, (1)-(2). It acts on a delayed velocity, so it "
              "costs device damping twice: condition (3)."},
             {"coupling.b_v", "b_v", &P::b_v, "N m s/rad", 0, 100, 1e-4, 1, true, true,
              "Damping of the proxy, (2). Felt through the coupling; condition (3) asks for "
              "at least k_vc T / 2."}}};
  }
};

// The same for all laws of the paper: what does nothing in one is there for the other.
inline constexpr std::array kPaperSliders{"coupling.eta", "observer.alpha", "coupling.k_vc",
                                          "coupling.b_vc", "coupling.b_v"};

// What (14)-(15) add to (1)-(2): without the contact torque f2, and of it, which is known only once
// the proxy has stepped. The proxy's share counts the f2 that acts on it anyway.
template <int N>
struct Feedforward {
  Vec<N> tau1, tau2;  // [N m]
  ContactShare<N> on_device{0}, on_proxy{1};

  static Feedforward none(Eigen::Index n) { return {Vec<N>::Zero(n), Vec<N>::Zero(n)}; }
};

// Steps the proxy, (4), with the springs and dampers of (2) at the midpoint; returns the torque on
// the device without its own damping, (1), which is what the motors are asked for [N m].
template <int N>
Vec<N> couple(const SpringDamper& p, const LawInput<N>& in, const Feedforward<N>& ff,
              Proxy<N>& proxy);

// Condition (3) for a constant tick: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2; and where the
// torque answers its reading a delay t_d late, b_d >= 2 b_vc + k_vc (T + 3/2 t_d) and
// b_v >= k_vc (T + t_d) / 2.
//
// Of d ticks' delay the device's torque lacks k_vc (x_E,k - x_E,k-d), whose work on dx1_k is at
// most
//     k_vc sum_j |dx1_k (dx1_k-j - dx2_k-j)| <= k_vc d (3/2 dx1^2 + 1/2 dx2^2),
// summed over the ticks; the dampers b_d, b_v take b/T dx^2. The bound of (3) itself is made so
// too.
struct Condition3 {
  double device_margin = 0;  // b_d less what is needed, at the joint with the least [N m s/rad]
  double proxy_margin = 0;   // b_v less what is needed [N m s/rad]
  bool holds = false;        // to round-off: the paper's own gains stand on the edge
};
// b_d: of every joint [N m s/rad]; T, the delay [s].
Condition3 condition3(const SpringDamper& p, double T, std::span<const double> b_d,
                      double delay = 0);

}  // namespace limpid
