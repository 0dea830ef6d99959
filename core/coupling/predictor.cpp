#include "core/coupling/predictor.h"

#include "core/touch/wall_force.h"

namespace limpid {
namespace {

constexpr double kMostMemory = 0.85;
constexpr double kQuiet = 1e-4;     // change of the tip's velocity allowed for a step [m/s]
constexpr double kLightest = 0.02;  // for tips from this on in part, from twice on in full [kg]

// Largest eigenvalue of a symmetric positive matrix, or up to 15 % more: the eighth root of the sum
// of the eigenvalues' eighth powers.
double largest_eigenvalue(const Mat3& A) {
  const double size = A.trace();
  if (!(size > 0)) return 0;
  Mat3 power = A / size;
  for (int i = 0; i < 3; ++i) power = (power * power).eval();
  return size * std::sqrt(std::sqrt(std::sqrt(power.trace())));
}

// Inverts g = 1.5 (1 - p)^2 (1 + p) for g up to 1.5: Newton's method from the value near p = 1.
double memory_of(double g) {
  double p = 1 - std::sqrt(std::min(g, 1.5) / 3);
  for (int i = 0; i < 6; ++i) {
    const double off = 1.5 * (1 - p) * (1 - p) * (1 + p) - g;
    p += off / (1.5 * (1 - p) * (1 + 3 * p));
  }
  return p;
}

}  // namespace

TipMoved tip_moved(const Mat3& mobility, const Mat3& levers) {
  return {1 / largest_eigenvalue(mobility), std::sqrt(largest_eigenvalue(levers))};
}

double WallMemory::shaken(double p, const TipMoved& tip) const {
  const double jump = velocity_jump(p, q, T) * tip.lever;
  return (K * T / 2 + wall_damping(K, tip.mass, T, damping, 0)) * jump * T / tip.mass;
}

double WallMemory::needed(double least, const TipMoved& tip) const {
  if (!(q > 0) || !(K > 0)) return least;
  const double share = std::clamp(tip.mass / kLightest - 1, 0.0, 1.0);
  if (!(share > 0)) return least;
  const double g = 1.5 * kQuiet / shaken(0, tip);
  const double p = g >= 1.5 ? least : std::clamp(memory_of(g), least, 1.0);
  return least + share * (p - least);
}

double WallMemory::possible(const TipMoved& tip) const {
  return std::min(kMostMemory, 1 - T * std::sqrt(K / tip.mass));
}

double WallMemory::chosen(double least, const TipMoved& tip) const {
  return std::max(least, std::min(needed(least, tip), possible(tip)));
}

}  // namespace limpid
