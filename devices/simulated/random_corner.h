// Random test cases: motors at their limit while the tip is between walls.
#pragma once

#include <span>

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
  static constexpr int kDofs[]{3};
  static constexpr double kFriction[]{0, 0.3, 0.5, 1}, kMasses[]{0, 0.02, 0.1};

  std::span<const int> dofs = kDofs;
  int planes = 3;      // most of them
  double grip = 3000;  // stiffest grip [N/m]
  std::span<const double> friction = kFriction;
  std::span<const double> masses = kMasses;  // of the hand [kg]
  bool eta = false;                          // draws eta, else 1
};
// Wider ranges: other arms, more walls, more friction, other eta.
inline constexpr int kWideDofs[]{3, 7, 12};
inline constexpr double kWideFriction[]{0, 0.3, 0.7, 1.5}, kWideMasses[]{0, 0.1, 0.5};
inline constexpr CornerWidth kWideCorners{.dofs = kWideDofs,
                                          .planes = 6,
                                          .grip = 10'000,
                                          .friction = kWideFriction,
                                          .masses = kWideMasses,
                                          .eta = true};

// Draws a corner by `seed`. Arms of as many joints as `desktop` are `desktop`; others are random.
LimitedCorner limited_corner(unsigned seed, const CornerWidth& width,
                             const ArmDescription& desktop);

}  // namespace limpid
