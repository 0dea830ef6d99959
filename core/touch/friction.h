// Coulomb friction as a spring with an anchor that slips (implicit, dissipative).
#pragma once

#include "core/math/sizes.h"

namespace limpid {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

// The tangential force l = disc[-K_t (z + T (b + W l))] [N], disc the projection on the disc of
// this radius [N]: z the stretch of the spring [m], b the tangential velocity without l [m/s], W
// what a force adds to it [m/(N s)]. With z' = -l/K_t the work of l over the tick and the change of
// K_t |z|^2/2 are together not positive.
inline Vec2 friction_force(double K_t, double radius, const Vec2& z, double T, const Vec2& b,
                           const Mat2& W) {
  if (!(radius > 0)) return Vec2::Zero();
  const auto disc = [radius](const Vec2& l) {
    const double size = l.norm();
    return size > radius ? Vec2(radius / size * l) : l;
  };
  const Mat2 stick = Mat2::Identity() + K_t * T * W;
  const double det = stick(0, 0) * stick(1, 1) - stick(0, 1) * stick(1, 0);
  const Vec2 drive = -K_t * (z + T * b);
  Vec2 l((stick(1, 1) * drive.x() - stick(0, 1) * drive.y()) / det,
         (stick(0, 0) * drive.y() - stick(1, 0) * drive.x()) / det);
  if (l.squaredNorm() <= radius * radius) return l;
  l = disc(l);
  const double rho = 1 / (1 + K_t * T * W.norm());
  for (int i = 0; i < 6; ++i) l = disc(l - rho * (stick * l - drive));
  return l;
}

}  // namespace limpid
