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

double WithheldEnergy::add(const RowLayout& layout, std::span<const double> row) {
  const auto of = [&](Column column) {
    return [values = layout.in(row, column)](int j) { return values[static_cast<std::size_t>(j)]; };
  };
  const auto commanded = of(Column::commanded_torque), own = of(Column::compensation_torque);
  return add(
      layout.dof(), of(Column::motor_torque), [&](int j) { return commanded(j) + own(j); },
      of(Column::device_position));
}

void EnergyShares::change(double time) {
  settled_ = time + kSettling;
  forgiven_ += std::max(0.0, own());
}

void EnergyShares::take(double time, double energy, double withheld, bool limited) {
  const bool settling = time <= settled_;
  const bool excused = settling || limited;
  if (excused && !excused_) peak_ = total_ - withheld_;
  excused_ = excused;
  total_ = energy;
  withheld_ = withheld;
  const double asked = energy - withheld;
  if (!excused || asked <= peak_) return;
  (settling ? changes_ : limits_) += asked - peak_;
  peak_ = asked;
}

}  // namespace limpid
