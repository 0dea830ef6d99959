// A hand that taps a flat wall with the tip of any arm and stays pressed on it, and what it felt.
#pragma once

#include "app/run/simulate.h"
#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"

namespace limpid {

// Where the tip meets the wall.
struct TapPlace {
  Eigen::VectorXd x;          // the arm there [rad]
  Vec3 point = Vec3::Zero();  // of the wall [m]
  Vec3 out = Vec3::UnitZ();   // unit, out of the wall

  // Of the device's tip in the wall [m].
  double depth(const Vec3& tip) const { return out.dot(point - tip); }
};
// At configuration x, along the direction in which the arm's dampers hold the tip least: there
// tip_limits() says how stiff a wall may be.
TapPlace tap_place(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p);

// The largest press up to `wanted` of which every motor bears twice as much [N].
double bearable_press(const ArmDescription& arm, const TapPlace& place, const Parameters& p,
                      double wanted);

struct WallTap {
  double wall = 600;    // [N/m]
  double press = 4;     // of the hand while it holds [N]
  double hold = 0.5;    // how long, from when it would be pressed if nothing swung [s]
  double judged = 0.2;  // the last part of it, in which it is to be at rest [s]

  static constexpr double kSpeed = 0.15,
                          kAbove = 0.005;  // of the hand, and where it starts [m/s, m]
  static constexpr double kFast = 20;      // what trembles is above [Hz]
};

// The hand's grip and all else is as `p` has it.
RunPlan tap_plan(const ArmDescription& arm, const TapPlace& place, const WallTap& tap,
                 const Parameters& p);

// Takes the rows of a run at a plane, and says what was felt of it from row `from` on.
class WallMeter {
 public:
  // `T` [s].
  WallMeter(const ArmDescription& arm, const Object& wall, double T, std::uint64_t from);

  void add(const RowLayout& layout, std::span<const double> row);

  // The wall's force over the device's depth in it, by the stiffness set; 0 if it was not in it.
  double felt() const;
  double rattle() const;  // rms of the wall's force above WallTap::kFast [N]

 private:
  Arm<kAnyDof> arm_;
  Vec3 point_, out_;  // of the wall
  double stiffness_;  // [N/m]
  HighPass fast_;
  std::uint64_t from_, row_ = 0;
  double fast2_ = 0, force_ = 0, depth_ = 0;
};
// Over the part of a tap that is judged.
WallMeter tap_meter(const RunPlan& plan, const WallTap& tap);

}  // namespace limpid
