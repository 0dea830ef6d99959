#include "app/experiments/harmonics.h"

#include <cmath>
#include <numbers>

namespace limpid {

std::complex<double> amplitude_at(const std::vector<double>& samples, double T, double f) {
  const double step = 2 * std::numbers::pi * f * T;
  // Turned on from sample to sample, and anew before round-off gathers.
  constexpr std::size_t kAnew = 64;
  const std::complex<double> turn = std::polar(1.0, -step);
  std::complex<double> sum = 0, at = 1;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    at = k % kAnew == 0 ? std::polar(1.0, -step * static_cast<double>(k)) : at * turn;
    sum += samples[k] * at;
  }
  return 2.0 * sum / static_cast<double>(samples.size());
}

double falls_through(const std::vector<double>& f, const std::vector<double>& value, double level) {
  for (std::size_t i = 1; i < f.size(); ++i) {
    if (value[i - 1] < level || value[i] >= level) continue;
    const double part = (value[i - 1] - level) / (value[i - 1] - value[i]);
    return f[i - 1] * std::pow(f[i] / f[i - 1], part);
  }
  return 0;
}

double growth_rate(const std::vector<double>& samples, double T) {
  const auto n = static_cast<double>(samples.size());
  double mean_log = 0;
  for (const double x : samples) mean_log += std::log(x) / n;
  double tt = 0, ty = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double t = (static_cast<double>(k) - (n - 1) / 2) * T;
    tt += t * t;
    ty += t * (std::log(samples[k]) - mean_log);
  }
  return ty / tt;
}

}  // namespace limpid
