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
//     C_LE   = M_L phidot + C1 phi + C2 (phi - I) = C2^T - (C1 + C2)^T phi = -C_EL^T
template <int N>
struct Decomposition {
  Mat<N> M_L;         // locked inertia [kg m^2]
  Mat<N> phi;         // (7) [-]
  Vec<N> v_L, v_E;    // (8) locked and shape velocity [rad/s]
  Mat<N> C_LE, C_EL;  // (11) [kg m^2/s]

  Decomposition(const Dynamics<N>& device, const Dynamics<N>& proxy) {
    M_L = device.M + proxy.M;
    phi = solve_symmetric<N>(M_L, proxy.M);
    v_E = device.v - proxy.v;
    v_L = device.v - phi * v_E;
    const Mat<N> C_L = device.C + proxy.C;
    C_LE = proxy.C.transpose();
    C_LE.noalias() -= C_L.transpose() * phi;
    C_EL = -C_LE.transpose();
  }
};

}  // namespace limpid
