#include "app/run/motor_limits.h"

#include <fmt/format.h>

#include <cmath>

namespace limpid {

std::vector<MotorLimit> motor_limits(const ArmDescription& arm, const Parameters& p) {
  std::vector<MotorLimit> limits;
  for (const Joint& joint : arm.joints) {
    limits.push_back(
        {std::isnan(p.torque_limit) ? joint.effort : p.torque_limit, joint.continuous});
  }
  return limits;
}

bool at_limit(const RowLayout& layout, std::span<const double> row,
              std::span<const MotorLimit> limits, int joint) {
  const auto j = static_cast<std::size_t>(joint);
  if (j >= limits.size()) return false;
  const double given = std::abs(layout.in(row, Column::motor_torque)[j]);
  const double asked = std::abs(layout.in(row, Column::commanded_torque)[j] +
                                layout.in(row, Column::compensation_torque)[j]);
  // A law that knows the limit asks for no more than that.
  const double most = limits[j].at(layout.in(row, Column::motor_warmth)[j]);
  return most > 0 && given >= most * (1 - 1e-9) && asked >= given * (1 - 1e-9);
}

bool any_at_limit(const RowLayout& layout, std::span<const double> row,
                  std::span<const MotorLimit> limits) {
  for (int j = 0; j < layout.dof(); ++j) {
    if (at_limit(layout, row, limits, j)) return true;
  }
  return false;
}

std::string warm_text(const ArmDescription& arm, const Parameters& p, const RowLayout& layout,
                      std::span<const double> row) {
  const std::vector<MotorLimit> limits = motor_limits(arm, p);
  const auto warmth = layout.in(row, Column::motor_warmth);
  const auto left = [&](std::size_t j) { return limits[j].at(warmth[j]) / limits[j].peak; };
  std::size_t least = 0;
  for (std::size_t j = 1; j < limits.size(); ++j) {
    if (left(j) < left(least)) least = j;
  }
  if (limits.empty() || !(left(least) < 1)) return {};
  const bool slides = arm.slides(least);
  const double unit = slides ? kSlideUnit : 1;
  return fmt::format("The motors are warm: joint {} gives at most {:.2g} of {:.2g} {}.",
                     arm.joints[least].name, limits[least].at(warmth[least]) / unit,
                     limits[least].peak / unit, slides ? "N" : "N m");
}

}  // namespace limpid
