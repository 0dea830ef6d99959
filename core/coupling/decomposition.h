// Passive decomposition of device and proxy into a locked and a shape system, (7)-(11).
#pragma once

#include "core/math/sizes.h"
#include "core/math/solve.h"

namespace limpid {

// M, C and velocity of one side, with Mdot - 2C skew.
template <int N>
struct Dynamics {
  Mat<N> M;  // [kg m^2]
  Mat<N> C;  // [kg m^2/s]
  Vec<N> v;  // [rad/s]
};

// The decomposition in closed form, with Mdot = C + C^T:
//     phi    = M_L^-1 M2,  M_L = M1 + M2
//     phidot = M_L^-1 (M2dot - M_Ldot phi)
//     C_LE   = M_L phidot + C1 phi + C2 (phi - I) = C2^T - (C1 + C2)^T phi = -C_EL^T
// Laws that solve with these matrices get them transposed.
template <int N>
class Locked {
 public:
  Locked(const Mat<N>& M1, const Mat<N>& C1, const Mat<N>& M_2, const Mat<N>& C_2)
      : M_L(M1 + M_2), M_L_factor(M_L), C_L(C1 + C_2), M2(M_2), C2(C_2) {}

  Wide<N> phi_T() const {
    Wide<N> share = widened<N>(M2);
    M_L_factor.divide(share);
    return share;
  }
  Wide<N> C_LE_T(const Wide<N>& phi_T) const {
    Wide<N> C = widened<N>(C2);
    take_product<N>(phi_T, widened<N>(C_L), C);
    return C;
  }
  Mat<N> phi() const { return narrowed<N>(phi_T()).transpose(); }
  Mat<N> C_LE(const Mat<N>& phi) const { return C2.transpose() - C_L.transpose() * phi; }

  Mat<N> M_L;  // locked inertia [kg m^2]
  SymmetricFactor<N> M_L_factor;
  Mat<N> C_L, M2, C2;  // C_L = C1 + C2; M2, C2 of the proxy
};

// The decomposition as products with vectors, which cost n^2.
template <int N>
class Decomposition : public Locked<N> {
 public:
  using Locked<N>::M_L_factor, Locked<N>::M2, Locked<N>::C2, Locked<N>::C_L;
  Decomposition(const Dynamics<N>& device, const Dynamics<N>& proxy)
      : Locked<N>(device.M, device.C, proxy.M, proxy.C),
        v_E(device.v - proxy.v),
        phi_v_E(times_phi(v_E)),
        v_L(device.v - phi_v_E) {}

  // phi v and phi^T f, (7).
  Vec<N> times_phi(const Vec<N>& v) const { return M_L_factor.solve((M2 * v).eval()); }
  Vec<N> times_phi_T(const Vec<N>& f) const { return M2 * M_L_factor.solve(f); }
  // C_LE v_E, (11) [N m].
  Vec<N> shape_torque() const { return C2.transpose() * v_E - C_L.transpose() * phi_v_E; }

  Vec<N> v_E, phi_v_E, v_L;  // (8) shape and locked velocity [rad/s]
};

}  // namespace limpid
