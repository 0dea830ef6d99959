#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/coupling/force_observer.h"
#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;
using test::T;

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
    EXPECT_LT((v.raw() - slope).norm(), 1e-11)
        << kVelocitySources[static_cast<std::size_t>(source)];
    EXPECT_LT((v.estimate() - slope).norm(), 1e-11)
        << kVelocitySources[static_cast<std::size_t>(source)];
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
  // 40 rad/s^2 and coarse encoders. The chord of a window of L ticks misses a parabola by a L^2 T^2
  // / 8, which may be a step and the rounding of three samples; the lag is L T a / 2.
  constexpr double step = 4e-4, a = 40;
  VelocityEstimator<kAnyDof> v(1);
  v.reset(one(0));
  for (int k = 1; k <= 500; ++k) {
    const double t = k * T;
    v.update(one(quantised(a * t * t / 2, step)), T, VelocitySource::adaptive, step);
    const double window = std::sqrt(8 * 2 * step / a);  // the longest possible [s]
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
  EXPECT_LT(adaptive, raw / 50);  // a window of 16 gives up to 256 times less
}

TEST(VelocityEstimator, LowPassFollowsTheImplicitRecurrenceAtEveryTick) {
  // y_k = y_k-1 + wT/(1 + wT) (raw_k - y_k-1), 50 Hz.
  constexpr double w = 2 * 3.14159265358979323846 * 50;
  for (const double tick : {1e-4, 1e-3, 1e-2}) {
    Random random(92);
    VelocityEstimator<kAnyDof> v(3);
    Eigen::VectorXd x = random.vector(3, 1), y = Eigen::VectorXd::Zero(3);
    v.reset(x);
    for (int k = 0; k < 300; ++k) {
      const Eigen::VectorXd next = x + random.vector(3, 0.01);
      const Eigen::VectorXd raw = (next - x) / tick;
      y += w * tick / (1 + w * tick) * (raw - y);
      x = next;
      v.update(x, tick, VelocitySource::lowpass, 0);
      ASSERT_LT((v.estimate() - y).norm(), 1e-12 * (1 + y.norm())) << tick << ' ' << k;
    }
  }
}

// Slope over the longest window of up to 16 ticks whose chord passes within a step of every sample,
// as all shorter ones' do; searched in all samples.
double end_fit(const std::vector<double>& x, double tick, double step) {
  const auto last = static_cast<int>(x.size()) - 1;
  const auto at = [&](int ago) { return x[static_cast<std::size_t>(last - ago)]; };
  int longest = 1;
  for (int length = 2; length <= std::min(16, last); ++length) {
    for (int i = 1; i < length; ++i) {
      const double on_chord = at(0) + (at(length) - at(0)) * i / length;
      if (std::abs(at(i) - on_chord) > step * (1 + 1e-9))
        return (at(0) - at(longest)) / longest / tick;
    }
    longest = length;
  }
  return (at(0) - at(longest)) / longest / tick;
}

TEST(VelocityEstimator, AdaptiveIsTheLongestChordThatFitsAllSamplesInIt) {
  constexpr double step = 4e-4;
  for (const double pace : {0.02, 0.3, 3.0}) {
    Random random(93);
    VelocityEstimator<kAnyDof> v(2);
    std::vector<double> x[2];
    double place[2] = {0.3, -1.1}, speed[2] = {0, 0};
    for (int k = 0; k < 600; ++k) {
      Vector sample(2);
      for (int i = 0; i < 2; ++i) {
        if (k % 70 == 0) speed[i] = random.between(-pace, pace);
        place[i] += T * speed[i];
        sample[i] = quantised(place[i], step);
        x[i].push_back(sample[i]);
      }
      if (k == 0) {
        v.reset(sample);
        continue;
      }
      v.update(sample, T, VelocitySource::adaptive, step);
      for (int i = 0; i < 2; ++i) {
        ASSERT_NEAR(v.estimate()[i], end_fit(x[i], T, step), 1e-9) << pace << ' ' << k;
      }
    }
  }
}

}  // namespace
}  // namespace limpid
