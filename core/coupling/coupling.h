// The virtual coupling: spring and damper of (1)-(2), feedforward of (14)-(15), condition (3).
#pragma once

#include <span>

#include "core/coupling/decomposition.h"
#include "core/loop/parameters.h"

namespace limpid {

// What (14)-(15) add to (1)-(2). The contact torque f2 is known only once the proxy has stepped,
// so its share stays a matrix: tau1 += tau1 + from_f2_1 f2, tau2 += tau2 + from_f2_2 f2.
template <int N>
struct Feedforward {
  Vec<N> tau1, tau2;            // [N m]
  Mat<N> from_f2_1, from_f2_2;  // [-]
};

template <int N>
Feedforward<N> feedforward(const Parameters& p, const Decomposition<N>& d, const Vec<N>& f1_hat) {
  const Eigen::Index n = f1_hat.size();
  Feedforward<N> ff;
  if (p.kind == CouplingKind::standard) {
    ff.tau1 = ff.tau2 = Vec<N>::Zero(n);
    ff.from_f2_1 = ff.from_f2_2 = Mat<N>::Zero(n, n);
    return ff;
  }
  const Mat<N> I = Mat<N>::Identity(n, n);
  const Mat<N> phi_T = d.phi.transpose();
  const Vec<N> locked = d.C_EL * d.v_L;
  const Vec<N> shape = d.C_LE * d.v_E;
  const Vec<N> phi_f1 = phi_T * f1_hat / p.eta;
  const Vec<N> phi_shape = phi_T * shape;
  ff.tau1 = locked + shape - phi_shape + (1 - p.eta) / p.eta * f1_hat - phi_f1;  // (14)
  ff.tau2 = -locked + phi_shape + phi_f1;                                        // (15)
  ff.from_f2_1 = (I - phi_T) / p.eta;  // (1 - eta)/eta I - phi^T/eta + I
  ff.from_f2_2 = phi_T / p.eta - I;
  return ff;
}

// Torque on the device without its own damping, (1): what the motors are asked for [N m].
//   v1    sampled velocity (x1_k - x1_k-1) / T
//   vbar2 mean velocity of the proxy over the last tick
template <int N>
Vec<N> device_torque(const Parameters& p, const Vec<N>& x1, const Vec<N>& v1, const Vec<N>& x2,
                     const Vec<N>& vbar2) {
  return -p.b_vc * (v1 - vbar2) - p.k_vc * (x1 - x2);
}

// Condition (3) for a constant tick: b_d >= 2 b_vc + k_vc T and b_v >= k_vc T / 2.
struct Condition3 {
  double device_margin = 0;  // b_d - 2 b_vc - k_vc T, at the joint with the least [N m s/rad]
  double proxy_margin = 0;   // b_v - k_vc T / 2 [N m s/rad]
  bool holds = false;        // to round-off: the paper's own gains stand on the edge
};
Condition3 condition3(const Parameters& p, std::span<const double> b_d);

}  // namespace limpid
