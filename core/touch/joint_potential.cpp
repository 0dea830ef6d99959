#include "core/touch/joint_potential.h"

#include <cmath>
#include <numbers>

#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kNoMove = 1e-10;  // motion below which the force is its value [m] or [rad]
constexpr int kMostSteps = 8;      // steps of Newton's method; two to four are usual

}  // namespace

bool JointPotential::any() const {
  return force_.spring != 0 || force_.detent_force != 0 || !force_.travel.empty() ||
         weight_cos_ != 0 || weight_sin_ != 0 || constant_ != 0;
}

// Force of the table: positive numbers push back, towards smaller s.
double JointPotential::table(double s, double& slope) const {
  const auto& t = force_.travel;
  slope = 0;
  if (t.empty()) return 0;
  if (s <= t.front()[0]) return t.front()[1];
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (s > t[i][0]) continue;
    slope = (t[i][1] - t[i - 1][1]) / (t[i][0] - t[i - 1][0]);
    return t[i - 1][1] + slope * (s - t[i - 1][0]);
  }
  return t.back()[1];
}

double JointPotential::travelled(double s) const {
  const auto& t = force_.travel;
  if (t.empty()) return 0;
  if (s <= t.front()[0]) return t.front()[1] * (s - t.front()[0]);
  double E = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double width = t[i][0] - t[i - 1][0];
    if (s <= t[i][0]) {
      const double part = s - t[i - 1][0];
      const double slope = (t[i][1] - t[i - 1][1]) / width;
      return E + part * (t[i - 1][1] + 0.5 * slope * part);
    }
    E += 0.5 * width * (t[i - 1][1] + t[i][1]);
  }
  return E + t.back()[1] * (s - t.back()[0]);
}

double JointPotential::energy(double s) const {
  double E = 0.5 * force_.spring * (s - force_.rest) * (s - force_.rest) - constant_ * s;
  if (force_.detent_force != 0) {
    const double k = 2 * std::numbers::pi / force_.detent_period;
    E += force_.detent_force / k * (1 - cosine(k * s));
  }
  if (weight_cos_ != 0 || weight_sin_ != 0) {
    const SineCosine at = sine_cosine(s);
    E += weight_cos_ * at.cosine + weight_sin_ * at.sine;
  }
  return E + travelled(s);
}

double JointPotential::force(double s) const {
  double slope;
  double F = constant_ - force_.spring * (s - force_.rest) - table(s, slope);
  if (force_.detent_force != 0) {
    F -= force_.detent_force * sine(2 * std::numbers::pi / force_.detent_period * s);
  }
  if (weight_cos_ != 0 || weight_sin_ != 0) {
    const SineCosine at = sine_cosine(s);
    F += weight_cos_ * at.sine - weight_sin_ * at.cosine;
  }
  return F;
}

double JointPotential::softness(double s) const {
  double slope;
  table(s, slope);
  double d = -force_.spring - slope;
  if (force_.detent_force != 0) {
    const double k = 2 * std::numbers::pi / force_.detent_period;
    d -= force_.detent_force * k * cosine(k * s);
  }
  if (weight_cos_ != 0 || weight_sin_ != 0) {
    const SineCosine at = sine_cosine(s);
    d += weight_cos_ * at.cosine + weight_sin_ * at.sine;
  }
  return d;
}

void JointPotential::over_a_tick(double s, double a, double c, double& F) const {
  const double E = energy(s);
  for (int i = 0; i < kMostSteps; ++i) {
    const double D = a + c * F;
    double mean, slope;  // of the force over D
    if (std::abs(D) < kNoMove) {
      mean = force(s + 0.5 * D);
      slope = 0.5 * softness(s);
    } else {
      mean = (E - energy(s + D)) / D;
      slope = (force(s + D) - mean) / D;
    }
    const double step = (mean - F) / std::max(0.1, 1 - c * slope);
    F += step;
    if (std::abs(step) <= 1e-13 * (1 + std::abs(F))) break;
  }
}

}  // namespace limpid
