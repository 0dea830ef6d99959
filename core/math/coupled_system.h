// Two sets of velocities that are solved for together.
#pragma once

#include "core/math/solve.h"

namespace limpid {

// Mean velocities over a tick of all that a contact can move [rad/s]. Bodies that move bring theirs
// along; what stands still has none.
template <int N>
struct Motion {
  Vec<N> w;  // of the device
  Vec<N> u;  // of the proxy

  void add(double force, const Motion& response) {
    w += force * response.w;
    u += force * response.u;
  }
};

// [ww wu; uw uu] (w, u) = (b_w, b_u), by the complement of the first block.
template <int N>
class CoupledSystem {
 public:
  CoupledSystem() = default;
  CoupledSystem(const Mat<N>& ww, const Mat<N>& wu, const Mat<N>& uw, const Mat<N>& uu)
      : first_(ww), across_(first_.solve(wu)), back_(uw), rest_(uu - back_ * across_) {}

  Motion<N> solve(const Motion<N>& b) const {
    const Vec<N> w = first_.solve(b.w);
    const Vec<N> u = rest_.solve(b.u - back_ * w);
    return {w - across_ * u, u};
  }

 private:
  Factor<N> first_;
  Mat<N> across_, back_;  // ww^-1 wu, and uw
  Factor<N> rest_;
};

}  // namespace limpid
