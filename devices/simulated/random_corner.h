// Random test cases: motors at their limit while the tip is between walls.
#pragma once

#include <initializer_list>

#include "core/tick/parameters.h"
#include "devices/simulated/rig.h"

namespace limpid {

// A hand presses the tip into the corner of a few planes, harder than the motors bear, and then
// rubs along it. Predictive coupling, 1 ms, exact encoders, no delay.
struct LimitedCorner {
  ArmDescription arm;
  Scene scene;
  Parameters p;
  RigStart start;
  Vec3 out, along;          // of the first plane: its normal, a direction along it
  double press, rise, way;  // [N, s, m]
  double limit;             // of each motor [N m]

  static constexpr double kLasts = 0.9;  // [s]

  Vec3 hand(double t) const;  // where the hand wants the tip [m]
};

// Ranges that a corner is drawn from.
struct CornerWidth {
  std::initializer_list<int> dofs{3};
  int planes = 3;      // most of them
  double grip = 3000;  // stiffest grip [N/m]
  std::initializer_list<double> friction{0, 0.3, 0.5, 1};
  std::initializer_list<double> masses{0, 0.02, 0.1};  // of the hand [kg]
  bool eta = false;                                    // draws eta, else 1
};
// Wider ranges: other arms, more walls, more friction, other eta.
inline constexpr CornerWidth kWideCorners{.dofs = {3, 7, 12},
                                          .planes = 6,
                                          .grip = 10'000,
                                          .friction = {0, 0.3, 0.7, 1.5},
                                          .masses = {0, 0.1, 0.5},
                                          .eta = true};

// Draws a corner by `seed`. Arms of as many joints as `desktop` are `desktop`; others are random.
LimitedCorner limited_corner(unsigned seed, const CornerWidth& width,
                             const ArmDescription& desktop);

}  // namespace limpid
