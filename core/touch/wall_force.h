// Forces of a wall over a whole tick: the normal force, by a discrete gradient, so that making,
// keeping and breaking contact neither gain nor lose energy; and friction.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/sizes.h"

namespace limpid {

using Mat2 = Eigen::Matrix2d;

// The slope of a force over a motion: with the damper's directions fixed, which is quickly found,
// or as it is where they change along the way.
enum class Slope : std::uint8_t { quick, whole };

// Coulomb friction as a spring with an anchor that slips, implicit and dissipative. Returns the
// tangential force l = disc[-K_t (z + T (b + W l))] [N], disc the projection on the disc of this
// radius [N]. z: stretch of the spring [m]; b: tangential velocity without l [m/s]; W: response to
// a force [m/(N s)]. With z' = -l/K_t the work of l over the tick and the change of K_t |z|^2/2 are
// together not positive.
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

// Damper that a wall of stiffness K gets by itself against the mass m_n [N s/m]. It is `part` of
// m_n/T, or half of critical damping if that is less. A heavy arm needs no more, and a wall that no
// joint can move along would brake. `jump`: of the velocity there by a step of the encoder [m/s];
// the damper's force from it is bounded.
inline double wall_damping(double K, double m_n, double T, double part, double jump) {
  constexpr double kPush = 0.05;  // [N]
  const double quiet = std::min(part * m_n / T, std::sqrt(K * m_n));
  return jump > 0 ? std::min(quiet, kPush / jump) : quiet;
}

// A wall of stiffness K [N/m] and damper B [N s/m] in a tick of T [s]. d: depth at the tick's start
// [m]; D = a - c F: change of depth over the tick, a without this wall's force, c > 0 the response
// to it [m, m/N]. In joint space with [rad] and [N m].
struct WallTick {
  double K, B, T;
  double d, a, c;
};

// The constant force F >= 0 [N] with F D = change of K max(0, d)^2 / 2 + work of B while inside.
inline double wall_force(const WallTick& w) {
  const double K = w.K, d = w.d, a = w.a, c = w.c, b = w.B / w.T;
  if (d >= 0) {
    const double F = std::max(0.0, (K * (d + a / 2) + b * a) / (1 + c * (K / 2 + b)));
    if (d + a - c * F >= 0) return F;  // inside throughout
    const double h = a - c * b * d;    // contact breaks: of K d^2 / 2 nothing stays
    const double rest = d * (K * d / 2 + b * a);
    const double root = std::sqrt(std::max(0.0, h * h + 4 * c * rest));
    // The larger root, in the form that does not subtract nearly equal numbers.
    return std::max(0.0, h < 0 ? 2 * rest / (root - h) : (h + root) / (2 * c));
  }
  const double s = d + a;
  if (s <= 0) return 0;  // apart throughout
  const double p = c * (c * (K / 2 + b) + 1);
  const double q = c * (K * s + b * (s + a)) + a;
  const double r = s * (K * s / 2 + b * a);
  return 2 * r / (q + std::sqrt(std::max(0.0, q * q - 4 * p * r)));  // contact is made
}

// The wall's force, and its slope over the change of depth [N/m], for a known D = a.
struct WallPush {
  double force = 0, slope = 0;
};
inline WallPush wall_push(const WallTick& w) {
  const double K = w.K, d = w.d, D = w.a, b = w.B / w.T, end = d + D;
  WallPush push;
  if (d >= 0 && end >= 0) {
    push = {K * (d + D / 2) + b * D, K / 2 + b};
  } else if (d >= 0) {
    push = {-K * d * d / (2 * D) - b * d, K * d * d / (2 * D * D)};
  } else if (end > 0) {
    const double inside = end / D;
    push = {K * end * inside / 2 + b * end, K * inside * (1 - inside / 2) + b};
  }
  return push.force > 0 ? push : WallPush{};
}

}  // namespace limpid
