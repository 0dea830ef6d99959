// The filter of an encoder's readings, against least squares over all of them and its theory.
#include "core/coupling/encoder_filter.h"

#include <gtest/gtest.h>

#include "core/dynamics/random.h"
#include "core/math/eigen.h"

namespace limpid {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// A motion by its unknowns, all normally distributed: its state at the beginning, then the change
// of the acceleration over each tick.
struct Motion {
  MatrixXd state;  // of them, row by row: position, velocity, acceleration
  MatrixXd prior;  // their covariance

  explicit Motion(Eigen::Index ticks)
      : state(MatrixXd::Identity(3, 3 + ticks)), prior(MatrixXd::Zero(3 + ticks, 3 + ticks)) {
    prior.diagonal().head(3) << 1e-8, 1, 1e4;
  }
  MatrixXd move(Eigen::Index tick, double T, double grown) {
    MatrixXd step = MatrixXd::Identity(3, 3);
    step.row(0) << 1, T, T * T / 2;
    step(1, 2) = T;
    state = step * state;
    state(2, 3 + tick) = 1;
    prior(3 + tick, 3 + tick) = grown * grown;
    return step;
  }
};

TEST(EncoderFilter, FindsWhatLeastSquaresOverAllReadingsDoes) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    constexpr Eigen::Index kTicks = 25;
    const double q = power(10, random.between(-6, -3));
    EncoderFilter filter;
    Motion motion(kTicks);
    VectorXd at = VectorXd::Zero(3), y(kTicks);
    MatrixXd read(kTicks, 3 + kTicks);
    for (Eigen::Index k = 0; k < kTicks; ++k) {
      const double T = random.between(2e-4, 3e-3), r = power(10, random.between(1, 5));
      at = motion.move(k, T, r * T) * at;
      read.row(k) = motion.state.row(0);
      y[k] = random.between(-1, 1) * q * 10;
      const EncoderFilter::Gains gains = filter.take(T, q, r);
      at += (y[k] - at[0]) * VectorXd{{gains.x, gains.v, gains.a}};

      const MatrixXd known = read.topRows(k + 1);
      MatrixXd S = known * motion.prior * known.transpose();
      S.diagonal().array() += q * q / 12;
      const MatrixXd across = motion.state * motion.prior * known.transpose();
      const VectorXd found = across * least_squares(S, y.head(k + 1));
      for (int i = 0; i < 3; ++i) {
        ASSERT_NEAR(at[i], found[i], 1e-3 * std::abs(found[i]) + 1e-7 * std::abs(at[2]));
      }
    }
  }
}

TEST(EncoderFilter, SettlesToGainsOfOneBandwidthWhateverTheTick) {
  constexpr double q = 4e-4, w = 60;
  const double r = w * w * w * q / std::sqrt(12.0);
  EXPECT_NEAR(filter_bandwidth(r, q), w, 1e-9 * w);
  EXPECT_NEAR(filter_rate(w, q), r, 1e-9 * r);
  for (const double T : {4e-4, 1e-4, 5e-5}) {
    EncoderFilter filter;
    EncoderFilter::Gains g{};
    for (double t = 0; t < 1; t += T) g = filter.take(T, q, r);
    const double off = 2 * w * T;  // a tick is no differential
    EXPECT_NEAR(g.x / (2 * w * T), 1, off);
    EXPECT_NEAR(g.v / (2 * w * w * T), 1, off);
    EXPECT_NEAR(g.a / (w * w * w * T), 1, off);
    EXPECT_NEAR((g.variance - q * q / 12) / (2 * w * T * q * q / 12), 1, 2 * off);
  }
}

TEST(EncoderFilter, TakesReadingsWithoutStepsAsTheyAre) {
  EncoderFilter filter;
  for (int k = 0; k < 100; ++k) EXPECT_EQ(filter.take(1e-3, 0, 1e3).x, 1);
}

TEST(EncoderFilter, IsSurprisedByWhatANormalErrorOfItsVarianceSeldomIs) {
  EncoderFilter::Gains g{};
  g.variance = 4e-8;
  const auto density = [](double e, double s) {
    return std::exp(-e * e / (2 * s * s)) / (s * std::sqrt(2 * std::acos(-1.0)));
  };
  for (const double e : {0.0, 1e-4, -3e-4}) {
    EXPECT_NEAR(g.surprise(e) - g.surprise(0), std::log(density(0, 2e-4) / density(e, 2e-4)), 1e-9);
  }
  EncoderFilter::Gains vague{};
  vague.variance = 4e-6;
  EXPECT_NEAR(vague.surprise(0) - g.surprise(0), std::log(10.0), 1e-9) << "it told ten times less";
}

// A Touch: 51.6 g, steps of 0.084 mm at the tip, 200 rad/s at rest.
TEST(EncoderFilter, IsAsQuickAsAHandAtRestOrAsTheWall) {
  constexpr double kMass = 0.0516, kStep = 8.4e-5;
  const auto bandwidth = [](double K) {
    return filter_bandwidth(resting_rate(K, kMass, kStep) / kMass, kStep);
  };
  EXPECT_NEAR(bandwidth(0), 200, 1);
  EXPECT_EQ(bandwidth(400), bandwidth(0)) << "88 rad/s";
  EXPECT_NEAR(bandwidth(8000), std::sqrt(8000 / kMass), 1e-6);
}

}  // namespace
}  // namespace limpid
