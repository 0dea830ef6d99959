// Limits of the motors' torque, and which motor is at its limit in a row.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/motor_warmth.h"
#include "core/tick/parameters.h"
#include "core/tick/row.h"

namespace limpid {

// Largest torque of a motor while it is cold, and the one that it bears for hours, 0 if that is not
// known [N m].
struct MotorLimit {
  double peak = 0;
  double continuous = 0;

  double at(double warmth) const { return warm_limit(peak, continuous, warmth); }
  friend bool operator==(const MotorLimit&, const MotorLimit&) = default;
};

// Returns the limit of each motor: the parameters' one, or the arm's own where they leave it to the
// arm.
std::vector<MotorLimit> motor_limits(const ArmDescription& arm, const Parameters& p);
// Returns whether the motor of a joint gives all it can in this row; never without a motor.
bool at_limit(const RowLayout& layout, std::span<const double> row,
              std::span<const MotorLimit> limits, int joint);
// Returns whether any motor gives all it can in this row.
bool any_at_limit(const RowLayout& layout, std::span<const double> row,
                  std::span<const MotorLimit> limits);
// Says which motor the warmth holds back most, and to which torque; empty if it holds none.
std::string warm_text(const ArmDescription& arm, const Parameters& p, const RowLayout& layout,
                      std::span<const double> row);

}  // namespace limpid
