#include "core/coupling/predictor.h"

namespace limpid {
namespace {

// Largest eigenvalue of a symmetric positive matrix, or up to 15 % more: the eighth root of the sum
// of the eigenvalues' eighth powers.
double largest_eigenvalue(const Mat3& A) {
  const double size = A.trace();
  if (!(size > 0)) return 0;
  Mat3 power = A / size;
  for (int i = 0; i < 3; ++i) power = (power * power).eval();
  return size * std::sqrt(std::sqrt(std::sqrt(power.trace())));
}

}  // namespace

TipMoved tip_moved(const Mat3& mobility, const Mat3& levers) {
  return {1 / largest_eigenvalue(mobility), std::sqrt(largest_eigenvalue(levers))};
}

}  // namespace limpid
