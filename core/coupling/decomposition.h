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

// In closed form, with Mdot = C + C^T:
//     phi    = M_L^-1 M2,  M_L = M1 + M2
//     phidot = M_L^-1 (M2dot - M_Ldot phi)
//     C_LE   = M_L phidot + C1 phi + C2 (phi - I) = -C_EL^T
template <int N>
struct Decomposition {
  Mat<N> M_L;       // locked inertia [kg m^2]
  Mat<N> phi;       // (7) [-]
  Vec<N> v_L, v_E;  // (8) locked and shape velocity [rad/s]
  Mat<N> C_LE, C_EL;  // (11) [kg m^2/s]

  Decomposition(const Dynamics<N>& device, const Dynamics<N>& proxy) {
    const Eigen::Index n = device.v.size();
    const Mat<N> I = Mat<N>::Identity(n, n);
    const Mat<N>& C1 = device.C;
    const Mat<N>& C2 = proxy.C;
    M_L = device.M + proxy.M;
    phi = solve<N>(M_L, proxy.M);
    v_E = device.v - proxy.v;
    v_L = device.v - phi * v_E;
    const Mat<N> M2dot = C2 + C2.transpose();
    const Mat<N> M_Ldot = C1 + C1.transpose() + M2dot;
    const Mat<N> phi_I = phi - I;
    C_LE = M2dot;
    C_LE.noalias() += (C1 - M_Ldot) * phi;
    C_LE.noalias() += C2 * phi_I;
    C_EL = -C_LE.transpose();
  }
};

}  // namespace limpid
