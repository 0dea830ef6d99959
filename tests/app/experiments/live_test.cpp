// The live experiments, with a simulated device behind encoders and a hand that nobody measures.
#include "app/experiments/live.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "app/experiments/coordination.h"
#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "core/dynamics/arm.h"

namespace limpid {
namespace {

const Vec3 kStart(0.2, 0, 0.01);

struct HandOf {
  std::function<Vec3(double)> at;
  double stiffness = 300;
};

class LiveExperiments : public testing::Test {
 protected:
  LiveLaboratory lab(const HandOf& hand) {
    LiveLaboratory lab;
    const RunPlan like = plan_in(built_in_arm().description, kTableScene,
                                 hand_path("still", 1e-3, 0.1, hand.at), {});
    lab.arm = like.arm;
    lab.document = like.document;
    lab.run = [this, hand](const LiveTrial& trial) { return run(hand, trial); };
    lab.stiffen = [this](double stiffness) { stiffness_ = stiffness; };
    return lab;
  }

  std::vector<LiveTrial> asked_;
  double encoder_step_ = 1e-5;

 private:
  Session run(const HandOf& hand, const LiveTrial& trial) {
    asked_.push_back(trial);
    Parameters p = trial.parameters;
    p.hand_stiffness = hand.stiffness;
    p.encoder_step = encoder_step_;
    RunPlan plan = plan_in(built_in_arm().description, kTableScene,
                           hand_path(trial.name, p.tick, trial.seconds, hand.at), p);
    set_surface_stiffness(plan.document.scene, stiffness_);
    Session s;
    s.info.tick = p.tick;
    s.layout = RowLayout(3);
    simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
      s.rows.insert(s.rows.end(), row.begin(), row.end());
      // A real device's hand is not measured.
      for (double& torque : s.layout.in(std::span(s.rows).last(row.size()), Column::hand_torque)) {
        torque = std::numeric_limits<double>::quiet_NaN();
      }
      return true;
    });
    return s;
  }

  double stiffness_ = 600;
};

Outcome run_the(const char* name, LiveLaboratory& bench) {
  const auto all = live_experiments();
  const auto it = std::ranges::find(all, std::string_view(name),
                                    [](const LiveExperiment& e) { return e.name; });
  return it->run(bench);
}

Vec3 pressing(double t) { return kStart - Vec3(0, 0, 0.031 * (1 - std::cos(2 * t))); }
Vec3 swinging(double t) { return kStart + 0.03 * Vec3(0, std::sin(5 * t), 0.5 * std::sin(7 * t)); }

TEST_F(LiveExperiments, CoordinationTellsTheCouplingsApart) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("coordination", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
  EXPECT_EQ(outcome.figure.panels.size(), 3u);
  ASSERT_EQ(asked_.size(), 2u);
  EXPECT_NE(asked_[0].instruction.find("standard"), std::string::npos);
}

TEST_F(LiveExperiments, CoordinationFailsWhereNothingIsTouched) {
  LiveLaboratory bench = lab({swinging});
  EXPECT_FALSE(run_the("coordination", bench).passed());
}

// Both runs have the same law: the second slope is no smaller than the first.
TEST_F(LiveExperiments, CoordinationFailsWhereTheCouplingsAreAlike) {
  LiveLaboratory bench = lab({pressing});
  bench.run = [run = bench.run](LiveTrial trial) {
    trial.parameters.kind = CouplingKind::standard;
    return run(trial);
  };
  const Outcome outcome = run_the("coordination", bench);
  EXPECT_FALSE(outcome.passed());
  const Check& last = outcome.checks.back();
  EXPECT_NEAR(last.value, 1, 1e-9) << last.what;
  EXPECT_FALSE(last.passed);
}

TEST_F(LiveExperiments, InertiaFindsEtaWithoutTheHandsTorque) {
  LiveLaboratory bench = lab({swinging, 3000});
  const Outcome outcome = run_the("inertia", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
}

TEST_F(LiveExperiments, PassivityFindsNoEnergyOnATable) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("passivity", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
}

TEST_F(LiveExperiments, ZwidthStiffensTheWallUntilItBuzzes) {
  encoder_step_ = 1e-4;
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("zwidth", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
  ASSERT_GT(asked_.size(), 2u);
  EXPECT_NE(asked_[0].instruction.find("250 N/m"), std::string::npos);
  EXPECT_NE(asked_[1].instruction.find("500 N/m"), std::string::npos);
}

TEST_F(LiveExperiments, ZwidthSaysThatTheWallWasNotTouched) {
  LiveLaboratory bench = lab({swinging});
  EXPECT_THROW(run_the("zwidth", bench), std::runtime_error);
}

// Compared with rows made by hand: a torque of 0.7 M a, and one joint with a damper.
TEST_F(LiveExperiments, WhatIsFeltIsTheTorqueAlongTheMotion) {
  const ArmDescription arm = lab({swinging}).arm;
  Session s;
  s.info.tick = 1e-3;
  s.layout = RowLayout(3);
  const Eigen::Vector3d rest = rest_pose(arm);
  for (int k = 0; k < 4000; ++k) {
    const double w = 6, t = 1e-3 * k;
    Eigen::Vector3d sway(0.1, -0.07, 0.12);
    const Eigen::Vector3d x = rest + sway * std::sin(w * t);
    const Eigen::Vector3d a = -w * w * sway * std::sin(w * t);
    Eigen::Vector3d torque = 0.7 * (arm_at(arm, x).M * a);
    torque += 0.02 * Eigen::Vector3d(std::cos(w * t), 0, 0);
    std::vector<double> row(static_cast<std::size_t>(s.layout.stride()), 0.0);
    const auto put = [&](Column c, const Eigen::Vector3d& v) {
      std::copy_n(v.data(), 3, s.layout.in(std::span(row), c).begin());
    };
    s.layout.in(std::span(row), Column::alpha)[0] = 1e9;  // an observer without a lag
    put(Column::device_position, x);
    put(Column::hand_torque_estimate, torque);
    s.rows.insert(s.rows.end(), row.begin(), row.end());
  }
  const Felt felt = felt_of(s, arm);
  EXPECT_NEAR(felt.inertia, 0.7, 0.01);
  EXPECT_NEAR(felt.damping[0], 0.02 / (0.1 * 6), 1e-3);
  EXPECT_NEAR(felt.damping[1], 0, 1e-3);
}

}  // namespace
}  // namespace limpid
