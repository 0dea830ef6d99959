// How hard and how quiet a wall is made by the motors: rate-hardness and ripple.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/dynamics/arm.h"
#include "core/tick/row.h"
#include "core/touch/scene.h"

namespace limpid {

// Takes a run's rows in turn. The motors' force is the shortest one at the tip that gives their
// torque, along the wall's normal.
class HardnessMeter {
 public:
  static constexpr double kInitial = 0.005;  // time that counts as the initial one [s]

  // wall: a plane; T [s]; from: first row in which the hand is taken to rest.
  HardnessMeter(const ArmDescription& arm, const Object& wall, double T, std::uint64_t from);

  void add(const RowLayout& layout, std::span<const double> row);

  // Rate-hardness (Lawrence, Pao, Dougherty, Salada and Pavlou 2000, IEEE T-RA 16, 357) [N/m]: the
  // initial rate of the force over the speed with which the tip first met the wall. Rate and speed
  // are means over kInitial, after and before. NaN if the tip met no wall, or the run ended then.
  double rate_hardness() const { return rate_hardness_; }
  // Rms of the force about its mean, over the rows from `from` on with the tip in the wall [N]; NaN
  // without such a row.
  double ripple() const;

 private:
  // Time since the tip met the wall, the speed, and the force then.
  struct Met {
    double since, speed, force;  // [s, m/s, N]
  };
  void follow(double depth, double force);

  Arm<kAnyDof> arm_;
  Arm<kAnyDof>::Frames frames_;
  Jacobian<kAnyDof> J_;
  Vec3 point_, out_;  // of the wall
  double T_;          // [s]
  std::uint64_t from_, row_ = 0;
  std::vector<double> depths_;  // of the last rows before the wall, the last one first [m]
  double before_ = 0;           // force of the last row [N]
  std::optional<Met> met_;
  double rate_hardness_;                         // [N/m]
  double pressed_ = 0, mean_ = 0, squares_ = 0;  // Welford's sums of the force
};

}  // namespace limpid
