#include "core/coupling/velocity_estimator.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;
constexpr double T = 1e-3;

Vector one(double x) { return Vector::Constant(1, x); }
double quantised(double x, double step) { return std::round(x / step) * step; }

TEST(VelocityEstimator, OfARampIsItsSlopeWithEverySource) {
  for (const auto source :
       {VelocitySource::raw, VelocitySource::lowpass, VelocitySource::adaptive}) {
    Random random(90);
    const Vector x0 = random.vector(3, 1), slope = random.vector(3, 2);
    VelocityEstimator<kAnyDof> v(3);
    v.reset(x0);
    // A low-pass of 50 Hz has forgotten the start after thirty time constants.
    for (int k = 1; k <= 200; ++k) v.update(x0 + k * T * slope, T, source, 0);
    EXPECT_LT((v.raw() - slope).norm(), 1e-11) << name(source);
    EXPECT_LT((v.estimate() - slope).norm(), 1e-11) << name(source);
  }
}

TEST(VelocityEstimator, StartsAtRest) {
  for (const auto source :
       {VelocitySource::raw, VelocitySource::lowpass, VelocitySource::adaptive}) {
    VelocityEstimator<kAnyDof> v(2);
    v.reset(Vector::Constant(2, 0.7));
    EXPECT_EQ(v.estimate().norm(), 0);
    for (int k = 0; k < 40; ++k) v.update(Vector::Constant(2, 0.7), T, source, 4e-4);
    EXPECT_EQ(v.estimate().norm(), 0);
  }
}

TEST(VelocityEstimator, LowPassAnswersAStepOfVelocityAsFirstOrder) {
  constexpr double w = 2 * 3.14159265358979 * 50, fine = 1e-5;
  VelocityEstimator<kAnyDof> v(1);
  v.reset(one(0));
  for (int k = 1; k <= 2000; ++k) {
    v.update(one(3 * k * fine), fine, VelocitySource::lowpass, 0);
    ASSERT_NEAR(v.estimate()[0], 3 * (1 - std::exp(-w * k * fine)), 3 * w * fine);
  }
}

TEST(VelocityEstimator, AdaptiveWithoutQuantisationIsTheRawDifference) {
  Random random(91);
  VelocityEstimator<kAnyDof> v(3);
  v.reset(Vector::Zero(3));
  for (int k = 0; k < 100; ++k) {
    v.update(random.vector(3, 1), T, VelocitySource::adaptive, 0);
    ASSERT_EQ(v.estimate(), v.raw());
  }
}

TEST(VelocityEstimator, AdaptiveOfASlowRampIsWithinAStepOverItsWindow) {
  // A chord over 16 ticks between two quantised ends misses the slope by a step over 16 T at most.
  constexpr double step = 4e-4;
  for (const double slope : {0.0213, 0.0517, 0.1319, 0.4231, 1.737, 5.119}) {
    VelocityEstimator<kAnyDof> v(1);
    v.reset(one(0));
    double worst_raw = 0, worst = 0;
    for (int k = 1; k <= 1000; ++k) {
      v.update(one(quantised(slope * k * T, step)), T, VelocitySource::adaptive, step);
      if (k < 32) continue;
      worst = std::max(worst, std::abs(v.estimate()[0] - slope));
      worst_raw = std::max(worst_raw, std::abs(v.raw()[0] - slope));
    }
    EXPECT_LE(worst, step / (16 * T) * (1 + 1e-9)) << slope;
    EXPECT_LE(worst, worst_raw + 1e-12) << slope;
  }
}

TEST(VelocityEstimator, AdaptiveOfAFastMotionDoesNotLag) {
  // 40 rad/s^2 and coarse encoders. Where the window is L ticks long its chord misses a parabola by
  // a L^2 T^2 / 8, which may be a step and the rounding of three samples; and L T a / 2 is the lag.
  constexpr double step = 4e-4, a = 40;
  VelocityEstimator<kAnyDof> v(1);
  v.reset(one(0));
  for (int k = 1; k <= 500; ++k) {
    const double t = k * T;
    v.update(one(quantised(a * t * t / 2, step)), T, VelocitySource::adaptive, step);
    const double window = std::sqrt(8 * 2 * step / a);  // longest there can be [s]
    const double bound = a * std::min(window, 16 * T) / 2 + step / T;
    ASSERT_NEAR(v.estimate()[0], a * t, bound) << k;
  }
}

TEST(VelocityEstimator, AdaptiveIsQuieterThanTheRawDifferenceInSlowMotion) {
  constexpr double step = 4e-4;
  VelocityEstimator<kAnyDof> v(1);
  v.reset(one(0));
  double raw = 0, adaptive = 0;
  for (int k = 1; k <= 4000; ++k) {
    const double t = k * T;
    v.update(one(quantised(0.05 * std::sin(2 * t), step)), T, VelocitySource::adaptive, step);
    const double truth = 0.1 * std::cos(2 * t);
    raw += std::pow(v.raw()[0] - truth, 2);
    adaptive += std::pow(v.estimate()[0] - truth, 2);
  }
  EXPECT_LT(adaptive, raw / 50);  // a window of 16: up to 256 times
}

}  // namespace
}  // namespace limpid
