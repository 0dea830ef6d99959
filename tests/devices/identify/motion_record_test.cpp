#include "devices/identify/motion_record.h"

#include <gtest/gtest.h>

#include <numbers>

namespace limpid {
namespace {

// A Gaussian window leaves exp(-w^2 sigma^2 / 2) of a sine, and its phase.
TEST(MotionAt, GivesASinesDerivativesDampedByTheWindow) {
  const double w = 2 * std::numbers::pi * 3;
  const Smoothing window{0.01};
  MotionRecord record;
  record.x.resize(4000, 1);
  for (Eigen::Index i = 0; i < 4000; ++i) record.x(i, 0) = std::sin(w * record.T * double(i)) + 2;
  record.torque = record.x;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(50, 0.31234, 3.5);
  const Motion3 motion = motion_at(record, window, times);
  const double left = std::exp(-0.5 * w * w * window.sigma * window.sigma);
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(motion.x(k, 0), 2 + left * std::sin(w * times[k]), 2e-6);
    EXPECT_NEAR(motion.v(k, 0), left * w * std::cos(w * times[k]), 1e-3);
    EXPECT_NEAR(motion.a(k, 0), -left * w * w * std::sin(w * times[k]), 0.2);
  }
}

// A torque held for a tick is half a tick late, besides its delay.
TEST(TorqueAt, GivesWhatActedDampedByTheWindow) {
  const double w = 2 * std::numbers::pi * 3, delay = 2.7e-3;
  const Smoothing window{0.01};
  MotionRecord record;
  record.torque.resize(4000, 1);
  for (Eigen::Index i = 0; i < 4000; ++i) record.torque(i, 0) = std::sin(w * record.T * double(i));
  record.x = record.torque;
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(50, 0.31234, 3.5);
  const Eigen::MatrixXd acted = torque_at(record, window, times, delay);
  const double left = std::exp(-0.5 * w * w * window.sigma * window.sigma);
  for (Eigen::Index k = 0; k < times.size(); ++k) {
    const double held = times[k] - delay - 0.5 * record.T;
    EXPECT_NEAR(acted(k, 0), left * std::sin(w * held), 2e-5);
  }
}

TEST(EncoderSteps, AreTheLeastMotionSeen) {
  MotionRecord record;
  record.x.resize(1000, 2);
  for (Eigen::Index i = 0; i < 1000; ++i) {
    const double x = std::sin(0.01 * double(i));
    record.x.row(i) << 2e-3 * std::round(x / 2e-3), 1e-4 * std::round(x / 1e-4);
  }
  record.torque = record.x;
  EXPECT_NEAR(encoder_steps(record)[0], 2e-3, 1e-12);
  EXPECT_NEAR(encoder_steps(record)[1], 1e-4, 1e-12);
}

// An encoder's readings are multiples of its step, apart from the last bits of the multiplication.
TEST(EncoderSteps, AreNotWhatRoundingLeaves) {
  MotionRecord record;
  record.x.resize(1000, 1);
  for (Eigen::Index i = 0; i < 1000; ++i) {
    const double x = std::sin(0.01 * double(i));
    record.x(i, 0) = 2e-3 * std::round(x / 2e-3) + (i % 2 == 0 ? 1e-15 : 0);
  }
  record.torque = record.x;
  EXPECT_NEAR(encoder_steps(record)[0], 2e-3, 1e-12);
}

}  // namespace
}  // namespace limpid
