#include "app/run/energy_shares.h"

#include <algorithm>

namespace limpid {

double spring_energy(const RowLayout& layout, std::span<const double> row) {
  const auto tau = layout.in(row, Column::commanded_torque);
  const auto x1 = layout.in(row, Column::device_position);
  const auto x2 = layout.in(row, Column::proxy_position);
  double twice = 0;
  for (std::size_t j = 0; j < tau.size(); ++j) twice -= tau[j] * (x1[j] - x2[j]);
  return std::max(0.0, 0.5 * twice);
}

void EnergyShares::change(double time) {
  settled_ = time + kSettling;
  forgiven_ += std::max(0.0, own());
}

void EnergyShares::take(double time, double energy, bool limited) {
  const bool settling = time <= settled_;
  const bool excused = settling || limited;
  if (excused && !excused_) peak_ = total_;
  excused_ = excused;
  total_ = energy;
  if (!excused || energy <= peak_) return;
  (settling ? changes_ : limits_) += energy - peak_;
  peak_ = energy;
}

}  // namespace limpid
