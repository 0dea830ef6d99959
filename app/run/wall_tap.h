// A hand that taps a flat wall with the tip of any arm and stays pressed on it, and what it felt.
#pragma once

#include "app/run/simulate.h"
#include "core/dynamics/arm.h"
#include "core/math/high_pass.h"

namespace limpid {

// Point at which the tip meets the wall.
struct TapPlace {
  Eigen::VectorXd x;          // at that point [rad]
  Vec3 point = Vec3::Zero();  // of the wall [m]
  Vec3 out = Vec3::UnitZ();   // unit, out of the wall

  // Returns how deep the device's tip is in the wall [m].
  double depth(const Vec3& tip) const { return out.dot(point - tip); }
};
// Places a wall at configuration x, across the direction in which the arm's dampers hold the tip
// least: there tip_limits() says how stiff a wall may be.
TapPlace tap_place(const ArmDescription& arm, const Eigen::VectorXd& x, const Parameters& p);

// Returns the largest press up to `wanted` [N] of which every motor bears twice as much.
double bearable_press(const ArmDescription& arm, const TapPlace& place, const Parameters& p,
                      double wanted);

// Returns how hard contacts push along the unit vector `out` [N]. forces: x, y, z of each [N].
double push_out(const Vec3& out, std::span<const double> forces);

struct WallTap {
  double wall = 600;    // [N/m]
  double press = 4;     // of the hand while it holds [N]
  double hold = 0.5;    // time from when it would be pressed if nothing swung [s]
  double judged = 0.2;  // last part of that time, in which it should rest [s]

  static constexpr double kSpeed = 0.15,
                          kAbove = 0.005;  // speed and starting height of the hand [m/s, m]
  static constexpr double kFast = 20;      // trembling is above this [Hz]
};

// Makes the plan of a run without a hand yet: at rest above a wall [N/m] at this place.
RunPlan wall_plan(const ArmDescription& arm, const TapPlace& place, double wall,
                  const Parameters& p);
// Makes the plan of a tap. The hand's grip and all else are those of `p`.
RunPlan tap_plan(const ArmDescription& arm, const TapPlace& place, const WallTap& tap,
                 const Parameters& p);

// Measures what was felt of a plane, from the rows of a run from row `from` on.
class WallMeter {
 public:
  // `T` [s].
  WallMeter(const ArmDescription& arm, const Object& wall, double T, std::uint64_t from);

  void add(const RowLayout& layout, std::span<const double> row);

  // Returns the wall's force over the device's depth in it, relative to the set stiffness; 0 if the
  // device was not in it.
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
// Returns a meter for the judged part of a tap.
WallMeter tap_meter(const RunPlan& plan, const WallTap& tap);

}  // namespace limpid
