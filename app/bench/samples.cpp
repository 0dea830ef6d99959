#include "app/bench/samples.h"

#include <algorithm>
#include <cmath>

namespace limpid::bench {

double Samples::quantile(double share) const {
  std::vector<double> sorted = values_;
  const auto last = static_cast<double>(sorted.size() - 1);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(std::floor(share * last));
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

}  // namespace limpid::bench
