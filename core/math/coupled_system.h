// Linear systems of two coupled sets of velocities.
#pragma once

#include "core/math/solve.h"

namespace limpid {

// Mean velocities over a tick of all that a contact can move [rad/s]. Moving bodies add their own
// velocities; fixed objects have none.
template <int N>
struct Motion {
  Vec<N> w;  // of the device
  Vec<N> u;  // of the proxy

  void add(double force, const Motion& response) {
    w += force * response.w;
    u += force * response.u;
  }
};

// Solves [ww wu; uw uu] (w, u) = (b_w, b_u) by the complement of the first block. Rest: that
// complement's factor; Factor where its symmetric part need not be positive definite.
template <int N, template <int> class Rest = SteadyFactor>
class CoupledSystem {
 public:
  CoupledSystem() = default;
  // Each argument: a wide matrix, or an expression of wide matrices.
  template <class WW, class WU, class UW, class UU>
  CoupledSystem(const WW& ww, const WU& wu, const UW& uw, const UU& uu) : across_(wu), back_(uw) {
    first_.compute(ww);
    first_.divide(back_);
    Wide<N> rest = uu;
    take_product<N>(back_, across_, rest);
    rest_.compute(rest);
  }

  Motion<N> solve(const Motion<N>& b) const {
    const Vec<N> u = rest_.solve((b.u - times<N>(back_, b.w)).eval());
    return {first_.solve((b.w - times<N>(across_, u)).eval()), u};
  }

 private:
  SteadyFactor<N> first_;
  Wide<N> across_, back_;  // wu, and uw ww^-1
  Rest<N> rest_;
};

}  // namespace limpid
