#include "app/base/welch.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace limpid {
namespace {

constexpr double kRate = 1000;

std::vector<double> sine(double amplitude, double frequency, std::size_t length) {
  std::vector<double> x(length);
  for (std::size_t i = 0; i < length; ++i) {
    x[i] = amplitude *
           std::sin(2 * std::numbers::pi * frequency * static_cast<double>(i) / kRate + 0.3);
  }
  return x;
}

std::vector<double> noise(std::size_t length) {
  std::mt19937 random(1);
  std::vector<double> x(length);
  for (double& value : x) value = static_cast<double>(random()) / 4294967295.0 - 0.5;
  return x;
}

TEST(Welch, FindsASineAtItsFrequencyWithHalfItsSquaredAmplitudeAsPower) {
  const std::size_t segment = 500;  // steps of 2 Hz: 40 Hz is a whole number of them
  const Spectrum s = welch(sine(3, 40, 5000), kRate, segment);
  EXPECT_DOUBLE_EQ(s.step, 2);
  const auto peak = std::max_element(s.density.begin(), s.density.end()) - s.density.begin();
  EXPECT_EQ(peak, 20);
  EXPECT_NEAR(s.power(), 4.5, 1e-12);
  // A Hann window spreads the peak over its two neighbours, a quarter each, and no further.
  EXPECT_NEAR(s.density[19] / s.density[20], 0.25, 1e-9);
  EXPECT_NEAR(s.density[21] / s.density[20], 0.25, 1e-9);
  EXPECT_NEAR(s.power(44) - s.power(34), 4.5, 1e-12);
  EXPECT_NEAR(s.power(34), 0, 1e-12);
}

TEST(Welch, KeepsParsevalsTheoremOfOneWindowedSegment) {
  const std::size_t n = 256;
  const std::vector<double> x = noise(n);
  double windowed = 0, window = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = std::pow(std::sin(std::numbers::pi * static_cast<double>(i) / n), 2);
    windowed += w * w * x[i] * x[i];
    window += w * w;
  }
  EXPECT_NEAR(welch(x, kRate, n).power(), windowed / window, 1e-14);
}

TEST(Welch, GivesWhiteNoiseItsVarianceAtEveryFrequency) {
  const Spectrum s = welch(noise(200000), kRate, 200);
  const double variance = 1.0 / 12, flat = variance / (kRate / 2);
  EXPECT_NEAR(s.power(), variance, 0.01 * variance);
  // About 2000 segments: a few per cent of scatter. The first and last bins hold half a step.
  for (std::size_t i = 2; i + 2 < s.density.size(); ++i) {
    EXPECT_NEAR(s.density[i], flat, 0.2 * flat) << i;
  }
}

TEST(Welch, PutsAConstantAtZero) {
  const Spectrum s = welch(std::vector<double>(1000, 2), kRate, 100);
  EXPECT_NEAR(s.power(), 4, 1e-12);
  EXPECT_NEAR(s.power(s.step), 4, 1e-12);  // power within the window's width
}

TEST(Welch, RefusesASignalShorterThanASegmentAndAnOddOne) {
  EXPECT_THROW(welch(std::vector<double>(99), kRate, 100), std::invalid_argument);
  EXPECT_THROW(welch(std::vector<double>(100), kRate, 99), std::invalid_argument);
  EXPECT_THROW(welch(std::vector<double>(100), kRate, 0), std::invalid_argument);
}

// The closed form: a sine of amplitude A is a peak of A at its frequency, where that is a whole
// number of steps, and of half of A beside it; nothing further away.
TEST(AmplitudeSpectrum, OfASineIsItsAmplitudeAtItsFrequency) {
  for (const double offset : {0.0, 17.0}) {
    std::vector<double> x = sine(0.3, 40, 4000);
    for (double& value : x) value += offset;
    const AmplitudeSpectrum s = amplitude_spectrum(x, kRate);
    ASSERT_DOUBLE_EQ(s.step, 0.5) << "three half-overlapping stretches of four seconds";
    ASSERT_EQ(s.amplitude.size(), 1001u);
    EXPECT_NEAR(s.amplitude[80], 0.3, 1e-9);
    EXPECT_NEAR(s.amplitude[79], 0.15, 1e-9);
    EXPECT_NEAR(s.amplitude[81], 0.15, 1e-9);
    EXPECT_NEAR(s.amplitude[100], 0, 1e-9);
    EXPECT_NEAR(s.amplitude[0], 0, 1e-9) << "the mean is taken away";
  }
}

TEST(AmplitudeSpectrum, DoesNotDependOnTheLength) {
  for (const std::size_t length : {400u, 10000u, 100000u}) {
    const AmplitudeSpectrum s = amplitude_spectrum(sine(2, 125, length), kRate);
    // Between two steps a Hann window loses 15 % at most.
    const double peak = *std::ranges::max_element(s.amplitude);
    EXPECT_GT(peak, 2 * 0.84) << length;
    EXPECT_LT(peak, 2 * 1.01) << length;
    EXPECT_GE(s.step, kRate / kLongestSegment) << length;
  }
}

TEST(AmplitudeSpectrum, NeedsAFewSamples) {
  EXPECT_TRUE(amplitude_spectrum(sine(1, 40, kFewestSamples - 1), kRate).empty());
  EXPECT_FALSE(amplitude_spectrum(sine(1, 40, kFewestSamples), kRate).empty());
}

}  // namespace
}  // namespace limpid
