#include "app/base/welch.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace limpid {

namespace {

// Guards FFTW's making and forgetting of plans, which only one thread at a time may do.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

struct Free {
  void operator()(void* memory) const { fftw_free(memory); }
  void operator()(fftw_plan plan) const {
    const std::lock_guard lock(planner());
    fftw_destroy_plan(plan);
  }
};

// Real transform of a fixed length, with its own storage.
class Transform {
 public:
  explicit Transform(std::size_t length)
      : in_(fftw_alloc_real(length)), out_(fftw_alloc_complex(length / 2 + 1)) {
    const std::lock_guard lock(planner());
    plan_.reset(
        fftw_plan_dft_r2c_1d(static_cast<int>(length), in_.get(), out_.get(), FFTW_ESTIMATE));
  }

  double* in() { return in_.get(); }
  void run() { fftw_execute(plan_.get()); }
  double squared(std::size_t i) const {
    const auto& c = out_.get()[i];
    return c[0] * c[0] + c[1] * c[1];
  }

 private:
  std::unique_ptr<double, Free> in_;
  std::unique_ptr<fftw_complex, Free> out_;
  std::unique_ptr<std::remove_pointer_t<fftw_plan>, Free> plan_;
};

std::vector<double> hann(std::size_t length) {
  std::vector<double> w(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(length);
    w[i] = 0.5 * (1 - std::cos(2 * std::numbers::pi * turn));
  }
  return w;
}

}  // namespace

double Spectrum::power(double up_to) const {
  double sum = 0;
  for (std::size_t i = 0; i < density.size() && static_cast<double>(i) * step <= up_to; ++i) {
    sum += density[i] * step;
  }
  return sum;
}

double Spectrum::power() const { return power(step * static_cast<double>(density.size())); }

Spectrum welch(std::span<const double> signal, double rate, std::size_t segment) {
  if (segment < 2 || segment % 2 != 0 || signal.size() < segment) {
    throw std::invalid_argument(
        "welch: the segment's length must be even and not longer than the signal");
  }
  const std::vector<double> window = hann(segment);
  double window_power = 0;
  for (const double w : window) window_power += w * w;

  const std::size_t bins = segment / 2 + 1;
  Spectrum spectrum{rate / static_cast<double>(segment), std::vector<double>(bins)};
  Transform transform(segment);
  std::size_t count = 0;
  for (std::size_t at = 0; at + segment <= signal.size(); at += segment / 2, ++count) {
    for (std::size_t i = 0; i < segment; ++i) transform.in()[i] = window[i] * signal[at + i];
    transform.run();
    for (std::size_t i = 0; i < bins; ++i) spectrum.density[i] += transform.squared(i);
  }
  for (std::size_t i = 0; i < bins; ++i) {
    // Negative frequencies count with the positive ones; 0 and the last bin have none.
    const double sides = i == 0 || i + 1 == bins ? 1 : 2;
    spectrum.density[i] *= sides / (rate * window_power * static_cast<double>(count));
  }
  return spectrum;
}

AmplitudeSpectrum amplitude_spectrum(std::span<const double> signal, double rate) {
  if (signal.size() < kFewestSamples) return {};
  // Three halves overlapping fill the stretch; longer ones take more of them, up to its newest end.
  const std::size_t segment = std::min(kLongestSegment, signal.size() / 4 * 2);
  const std::size_t half = segment / 2;
  std::vector<double> swing(signal.end() - static_cast<std::ptrdiff_t>(signal.size() / half * half),
                            signal.end());
  const double mean =
      std::accumulate(swing.begin(), swing.end(), 0.0) / static_cast<double>(swing.size());
  for (double& x : swing) x -= mean;
  const Spectrum power = welch(swing, rate, segment);
  // A sine of power A^2 / 2 is spread over the window's noise bandwidth, 3/2 bins of Hann's.
  AmplitudeSpectrum spectrum{power.step, power.density};
  for (double& x : spectrum.amplitude) x = std::sqrt(2 * 1.5 * x * power.step);
  return spectrum;
}

}  // namespace limpid
