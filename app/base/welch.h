// Power and amplitude over frequency by Welch's method.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limpid {

// Power over frequency, one-sided: density[i] is the power per hertz at i * step, so that the sum
// over all i of density[i] * step is the mean square of the signal.
struct Spectrum {
  double step = 0;              // [Hz]
  std::vector<double> density;  // [unit^2 / Hz]

  double power(double up_to) const;  // from 0 to a frequency [Hz], in [unit^2]
  double power() const;
};

// Averages over the half-overlapping stretches of `segment` samples (an even number) that fit, each
// under a Hann window; nothing is detrended. `rate` [Hz]. Errors: std::invalid_argument if the
// signal is shorter than a segment.
Spectrum welch(std::span<const double> signal, double rate, std::size_t segment);

// Amplitudes over frequency: a sine of amplitude A stands as A at its frequency, whatever the
// length, or with up to 15 % less between two steps; amplitude[i] in the signal's unit at i * step.
struct AmplitudeSpectrum {
  double step = 0;  // [Hz]
  std::vector<double> amplitude;

  bool empty() const { return amplitude.empty(); }
};

// Takes the root mean square over three or more half-overlapping stretches of the signal, less its
// mean, each of kLongestSegment samples at most. Empty for fewer than kFewestSamples. `rate` [Hz].
inline constexpr std::size_t kFewestSamples = 64, kLongestSegment = 16384;
AmplitudeSpectrum amplitude_spectrum(std::span<const double> signal, double rate);

}  // namespace limpid
