// Energy of a device by readings of encoders with steps: the loss that its dampers surely had, and
// a path for the work of its motors.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/sizes.h"

namespace limpid {

// Returns what dampers b [N m s/rad] took at least while the readings changed by dy in the time T
// [rad, s, J]. Each joint is within half a step q of its reading, so it moved by at least abs(dy) -
// q; of all motions by a way s in the time T an even one loses least, b s^2/T.
template <int N>
double sure_loss(const Vec<N>& b, const Vec<N>& dy, double q, double T) {
  double loss = 0;
  for (Eigen::Index i = 0; i < dy.size(); ++i) {
    const double s = std::max(0.0, std::abs(dy[i]) - q);
    loss += b[i] * s * s / T;
  }
  return loss;
}

// Returns y moved by `off` within the cells of these readings, which reach q/2 to both sides [rad].
// With no better estimate `off` is half of the last change back: where a reading changes, the edge
// that was crossed. Along the readings themselves a spring k would seem to give k q^2/2 at each
// change.
template <int N>
Vec<N> within_cells(const Vec<N>& y, const Vec<N>& off, double q) {
  return y + off.cwiseMin(q / 2).cwiseMax(-q / 2);
}

}  // namespace limpid
