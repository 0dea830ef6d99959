#include "app/run/energy_shares.h"

#include <algorithm>
#include <cmath>

namespace limpid {

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

std::vector<double> motor_limits(const ArmDescription& arm, const Parameters& p) {
  std::vector<double> limits;
  for (const Joint& joint : arm.joints) {
    limits.push_back(std::isnan(p.torque_limit) ? joint.effort : p.torque_limit);
  }
  return limits;
}

bool at_limit(const RowLayout& layout, std::span<const double> row, std::span<const double> limits,
              int joint) {
  const auto j = static_cast<std::size_t>(joint);
  if (j >= limits.size()) return false;
  const double given = std::abs(layout.in(row, Column::motor_torque)[j]);
  const double asked = std::abs(layout.in(row, Column::commanded_torque)[j] +
                                layout.in(row, Column::compensation_torque)[j]);
  // A law that knows the limit asks for no more than that.
  return given >= limits[j] * (1 - 1e-9) && asked >= given * (1 - 1e-9);
}

bool any_at_limit(const RowLayout& layout, std::span<const double> row,
                  std::span<const double> limits) {
  for (int j = 0; j < layout.dof(); ++j) {
    if (at_limit(layout, row, limits, j)) return true;
  }
  return false;
}

}  // namespace limpid
