// Taps on a table: the hand's way, the settings, and what is read from a run's rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/experiments/tap_bench.h"

namespace limpid {
namespace {

// 4 N on 500 N/m in a grip of 300 N/m: down by 20 mm, and by what wall and grip yield.
constexpr double kTapped = 500, kHeld = 300, kWay = 0.02 + 4.0 / kHeld + 4.0 / kTapped;
constexpr double kDownAt = 0.1 + kWay / 0.15, kOneTap = 2 * (0.1 + kWay / 0.15) + 0.5;  // [s]

TEST(TapOfTheTable, GoesDownHoldsAndComesBack) {
  const ExperimentArm on = built_in_arm();
  for (const int taps : {1, 3}) {
    const HandPath hand = TapBench(on, {}, kTapped, kHeld, taps).trial().plan.hand;
    EXPECT_NEAR(static_cast<double>(hand.time.size()) * 1e-3, taps * kOneTap, 2e-3);
    const auto height = [&](double t) {
      return hand.sample(static_cast<std::size_t>(std::llround(t / 1e-3)), 1e-3).z();
    };
    for (int tap = 0; tap < taps; ++tap) {
      const double from = tap * kOneTap;
      EXPECT_NEAR(height(from + 0.05), -0.02, 1e-6) << "it waits above";
      EXPECT_NEAR(height(from + 0.2), -0.02 - 0.1 * 0.15, 2e-4);
      EXPECT_NEAR(height(from + kDownAt + 0.01), -0.02 - kWay, 1e-6);
      EXPECT_NEAR(height(from + kDownAt + 0.49), -0.02 - kWay, 1e-6) << "it holds for 0.5 s";
      EXPECT_NEAR(height(from + kDownAt + 0.5 + 0.1), -0.02 - kWay + 0.1 * 0.15, 2e-4);
      EXPECT_NEAR(height(from + kOneTap - 0.05), -0.02, 1e-6);
    }
    EXPECT_NEAR(hand.sample(300, 1e-3).x(), 0.2, 1e-12);
    EXPECT_NEAR(hand.sample(300, 1e-3).y(), 0, 1e-12);
  }
  const Trial trial = TapBench(on, {}, kTapped, kHeld, 1).trial();
  EXPECT_FALSE(trial.keep);
  ASSERT_EQ(trial.plan.document.scene.objects.size(), 1u);
  EXPECT_EQ(trial.plan.document.scene.objects[0].material.stiffness, kTapped);
  EXPECT_NEAR(trial.plan.document.scene.objects[0].pose.translation().z(), -0.04, 1e-12);
}

TEST(TapOfTheTable, HoldsAsLongAndAsHardAsItIsTold) {
  const ExperimentArm on = built_in_arm();
  const TapSetting longer{.press = 2, .hold = 6};
  const HandPath hand = TapBench(on, longer, 1000, 3000, 1).trial().plan.hand;
  const double way = 0.02 + 2.0 / 3000 + 2.0 / 1000, down = 0.1 + way / 0.15;
  EXPECT_NEAR(static_cast<double>(hand.time.size()) * 1e-3, 2 * down + 6, 2e-3);
  for (const double t : {down + 0.01, down + 5.99}) {
    EXPECT_NEAR(hand.sample(static_cast<std::size_t>(t / 1e-3), 1e-3).z(), -0.02 - way, 1e-6);
  }
}

TEST(TapOfTheTable, IsMadeWithItsSetting) {
  const ExperimentArm on = built_in_arm();
  const auto of = [&](const TapSetting& s) {
    return TapBench(on, s, kTapped, kHeld, 1).parameters();
  };
  const Parameters usual = of({});
  EXPECT_EQ(usual.kind, CouplingKind::predictive);
  EXPECT_EQ(usual.eta, 1);
  EXPECT_EQ(usual.hand_stiffness, kHeld);
  EXPECT_EQ(usual.hand_damping, 2);
  EXPECT_EQ(usual.torque_limit, 100);
  EXPECT_EQ(usual.encoder_step, 0);
  EXPECT_EQ(usual.hand_mass_at_tip, 0);
  EXPECT_GT(usual.hand_mass, 0);
  EXPECT_EQ(usual.device_delay, 0);
  EXPECT_EQ(usual.link_delay, 0);
  for (const double tick : {0.00025, 0.0005, 0.002}) {
    const Parameters p = of({.tick = tick});
    EXPECT_EQ(p.tick, tick);
    EXPECT_NEAR(p.tick / p.substeps, usual.tick / usual.substeps, 1e-12) << "the device's step";
  }
  EXPECT_EQ(of({.tick = 1e-5}).substeps, 1);
  const Parameters heavy = of({.hand_mass = 0.3, .expects_a_mass = false});
  EXPECT_EQ(heavy.hand_mass_at_tip, 0.3);
  EXPECT_EQ(heavy.hand_mass, 0);
  EXPECT_TRUE(std::isnan(of({.own_motors = true}).torque_limit));
  EXPECT_EQ(of({.torque_limit = 0.4}).torque_limit, 0.4);
  const Parameters late = of({.delay = 3}), unaware = of({.delay = 3, .knows_delay = false});
  EXPECT_EQ(late.device_delay, 3);
  EXPECT_EQ(late.delay, 3);
  EXPECT_EQ(unaware.device_delay, 3);
  EXPECT_EQ(unaware.delay, 0);
  EXPECT_EQ(of({.link = 7}).link_delay, 7);
  EXPECT_EQ(of({.kind = CouplingKind::proposed, .eta = 0.3}).eta, 0.3);
  EXPECT_EQ(of({.kind = CouplingKind::proposed}).kind, CouplingKind::proposed);
}

// Rows of a tap whose device is 5 mm below the table all the time; `turn`: of its first joint.
// `judged` is the force in the last 0.2 s of the hold, else it is 100 N.
TrialResult pressed_rows(const ExperimentArm& on, double judged,
                         const std::function<double(double)>& turn) {
  TrialResult made;
  Session& s = made.session;
  s.info.tick = 1e-3;
  s.layout = RowLayout(3);
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  const auto rows = static_cast<std::size_t>(kOneTap / 1e-3);
  s.rows.assign(rows * stride, 0.0);
  const Eigen::VectorXd rest = rest_at(on.description, Vec3(0.2, 0, -0.045)).x1;
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    const auto row = std::span(s.rows).subspan(k * stride, stride);
    Eigen::VectorXd x = rest;
    x[0] += turn(t);
    std::ranges::copy(x, s.layout.in(row, Column::device_position).begin());
    const bool held = t > kDownAt + 0.298 && t < kDownAt + 0.502;
    s.layout.in(row, Column::contact_force)[2] = held ? judged : 100;
    s.layout.in(row, Column::contact_torque)[1] = k == 7 ? -0.3 : 0.2;
    s.layout.in(row, Column::energy_total)[0] = k == 9 ? 0.04 : 0.01;
    s.layout.in(row, Column::energy_port)[0] = k == 11 ? 0.03 : -0.01;
  }
  return made;
}

TEST(TouchOfATap, HasTheForceOverTheDepthAtTheEndOfTheHold) {
  const ExperimentArm on = built_in_arm();
  const TapBench bench(on, {}, kTapped, kHeld, 1);
  const Touch still = bench.touch(pressed_rows(on, 2, [](double) { return 0.0; }));
  EXPECT_NEAR(still.felt, 2 / 0.005 / kTapped, 1e-3);
  EXPECT_EQ(still.torque, 0.3);
  EXPECT_EQ(still.energy, 0.04);
  EXPECT_EQ(still.port, 0.03);
  EXPECT_NEAR(still.chatter, 0, 1e-9);
  EXPECT_NEAR(still.moving, 0, 1e-9);
}

// 200 mm from the first joint's axis: swings of 5 Hz are motion, those of 50 Hz chatter as well.
TEST(TouchOfATap, ChattersAbove20HertzAlone) {
  const ExperimentArm on = built_in_arm();
  const TapBench bench(on, {}, kTapped, kHeld, 1);
  const auto swings = [](double by, double hertz) {
    return [=](double t) { return by * std::sin(2 * std::numbers::pi * hertz * t); };
  };
  const auto speed = [](double by, double hertz) {
    return 0.2 * by * 2 * std::numbers::pi * hertz / std::numbers::sqrt2;
  };
  const Touch fast = bench.touch(pressed_rows(on, 2, swings(1e-4, 50)));
  EXPECT_NEAR(fast.chatter, speed(1e-4, 50), 0.02 * speed(1e-4, 50));
  EXPECT_NEAR(fast.moving, speed(1e-4, 50), 0.02 * speed(1e-4, 50));
  const Touch slow = bench.touch(pressed_rows(on, 2, swings(1e-3, 5)));
  EXPECT_NEAR(slow.moving, speed(1e-3, 5), 0.02 * speed(1e-3, 5));
  EXPECT_LT(slow.chatter, 0.01 * slow.moving);
}

}  // namespace
}  // namespace limpid
