// Verdicts on runs with moving bodies, from rows made by hand.
#include "app/experiments/moving.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/run/analysis.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

TrialResult with_a_body(std::size_t rows) {
  TrialResult made;
  made.session.layout = RowLayout(3, 1);
  made.session.rows.assign(rows * static_cast<std::size_t>(made.session.layout.stride()), 0.0);
  return made;
}

void set_column(Session& s, Column c, const std::vector<double>& values) {
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  for (std::size_t k = 0; k < values.size(); ++k) {
    s.layout.in(std::span(s.rows).subspan(k * stride, stride), c)[0] = values[k];
  }
}

TEST(MovingVerdict, HasTheWorstOfEachRow) {
  TrialResult made = with_a_body(4);
  Session& s = made.session;
  set_column(s, Column::energy_total, {-0.1, 0.3, 0.1, 0.2});
  set_column(s, Column::energy_port, {0.1, 0.2, 0.05, 0});
  set_column(s, Column::energy_to_objects, {0.05, -0.3, 0.2, 0.1});
  set_column(s, Column::objects_gain, {0, -1, 2e-7, 1e-7});
  set_column(s, Column::energy_ledger, {1, 0.7, 1.2, 0.9});
  set_column(s, Column::governor, {1, 0.6, 0.8, 1});
  set_column(s, Column::objects_sweeps, {2, 9, 4, 0});
  set_column(s, Column::solved, {1, 3, 2, 3});
  const MovingVerdict v = judge_moving(made);
  EXPECT_EQ(v.energy, 0.3);
  EXPECT_NEAR(v.beyond, 0.25, 1e-15);
  EXPECT_EQ(v.gain, 2e-7);
  EXPECT_NEAR(v.reserve, -0.3, 1e-15);
  EXPECT_EQ(v.governor, 0.6);
  EXPECT_EQ(v.sweeps, 9);
  EXPECT_EQ(v.unsolved, 2);
  EXPECT_NEAR(beyond_at(s, 1), -0.1, 1e-15);
}

TEST(MovingVerdict, IsGoodOfARunInWhichNothingCame) {
  TrialResult made = with_a_body(2);
  set_column(made.session, Column::governor, {1, 1});
  set_column(made.session, Column::energy_ledger, {0.5, 0.6});
  const MovingVerdict v = judge_moving(made);
  EXPECT_EQ(v.energy, 0);
  EXPECT_EQ(v.beyond, 0);
  EXPECT_EQ(v.gain, 0);
  EXPECT_EQ(v.reserve, 0);
  EXPECT_EQ(v.governor, 1);
  EXPECT_EQ(v.unsolved, 0);
}

TEST(MovingVerdict, IsAsBadAsCanBeOfWhatDiverged) {
  TrialResult made = with_a_body(2);
  made.end.diverged = true;
  const MovingVerdict v = judge_moving(made);
  for (const double energy : {v.energy, v.beyond, v.gain, -v.reserve}) {
    EXPECT_EQ(energy, HUGE_VAL);
  }
  EXPECT_LT(v.governor, 1);
}

TEST(SceneOfBoxes, HasEachBoxAsItWasGiven) {
  const std::string text = scene_of({{.name = "low",
                                      .size = {0.01, 0.02, 0.03},
                                      .mass = 0.2,
                                      .at = {0.25, 0.125, -0.05},
                                      .stiffness = 700,
                                      .friction = 0.4},
                                     {.name = "high", .more = "magnet = true\n"}},
                                    "gravity = [0, 0, -3]\n");
  const HandPath still = hand_path("still", 1e-3, 0.01, [](double) { return Vec3(0.18, 0, 0); });
  const Scene scene = plan_in(test::omni(), text, still, {}).document.scene;
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -3));
  ASSERT_EQ(scene.objects.size(), 2u);
  const Object &low = scene.objects[0], &high = scene.objects[1];
  EXPECT_EQ(low.name, "low");
  EXPECT_EQ(std::get<Box>(low.shape).size, Vec3(0.01, 0.02, 0.03));
  EXPECT_EQ(low.pose.translation(), Vec3(0.25, 0.125, -0.05));
  EXPECT_EQ(low.material.stiffness, 700);
  EXPECT_EQ(low.material.friction_static, 0.4);
  EXPECT_EQ(low.material.friction_kinetic, 0.4);
  ASSERT_TRUE(low.body && high.body);
  EXPECT_EQ(low.body->mass, 0.2);
  EXPECT_FALSE(low.body->magnet);
  EXPECT_TRUE(high.body->magnet);
  EXPECT_EQ(high.body->mass, 0.05);
  EXPECT_EQ(high.material.stiffness, 2000);
}

// A force that turns from tick to tick, through the joints and back.
TEST(RecordOfTheTip, HasPlacesAndTheForcesBetweenThem) {
  const ArmDescription arm = test::omni();
  Session s;
  s.info.tick = 2e-3;
  s.layout = RowLayout(3);
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  constexpr std::size_t kRows = 20;
  s.rows.assign(kRows * stride, 0.0);
  const auto pose = [&](std::size_t k) {
    return Eigen::VectorXd(rest_pose(arm) +
                           0.01 * static_cast<double>(k) * Eigen::Vector3d(1, -0.5, 0.7));
  };
  const auto pushed = [](std::size_t k) {
    return Vec3(std::cos(0.3 * static_cast<double>(k)), 0.5, -0.1 * static_cast<double>(k));
  };
  for (std::size_t k = 0; k < kRows; ++k) {
    const auto row = std::span(s.rows).subspan(k * stride, stride);
    const Eigen::VectorXd x = pose(k);
    const Eigen::VectorXd torque = arm_at(arm, (x + pose(k + 1)) / 2).J.transpose() * pushed(k);
    std::ranges::copy(x, s.layout.in(row, Column::device_position).begin());
    std::ranges::copy(torque, s.layout.in(row, Column::hand_torque).begin());
  }
  const TipRecord record = tip_record(arm, s);
  EXPECT_EQ(record.tick, 2e-3);
  ASSERT_EQ(record.tip.size(), kRows);
  ASSERT_EQ(record.force.size(), kRows - 1);
  for (std::size_t k = 0; k < kRows; ++k) {
    EXPECT_LT((record.tip[k] - tip_at(arm, pose(k))).norm(), 1e-12);
    if (k + 1 < kRows) {
      EXPECT_LT((record.force[k] - pushed(k)).norm(), 1e-9) << k;
    }
  }
}

}  // namespace
}  // namespace limpid
