// The second run beside the loop's, tick by tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/live/further_lane.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

TEST(SecondRun, BeginsWithTheForceThatTheFirstHas) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  const Scene& scene = plan.document.scene;
  const Vec3 target = plan.hand.at(0);
  for (const bool armed : {false, true}) {
    Rig first(plan.arm, scene);
    RigStart start = rest_at(plan.arm, target);
    first.start(plan.parameters, start);
    FurtherLane second;
    second.open(std::make_unique<Rig>(plan.arm, scene));
    test::Rows one(first.layout()), other(first.layout());
    RigInput input{.hand = {target + Vec3(0.01, 0.01, 0), 1}};
    input.force = armed ? ForceRequest::as_it_is : ForceRequest::cut;
    const auto tick = [&](bool on) {
      first.step(plan.parameters, input, one.add());
      second.step(on, plan.parameters, first, input, other.add());
      input.force = ForceRequest::as_it_is;
    };
    for (int k = 0; k < 50; ++k) tick(false);
    double pushed = 0;
    for (int k = 0; k < 50; ++k) {
      tick(true);
      const std::size_t last = other.size() - 1;
      ASSERT_EQ(other.at(last, Column::force_wanted), armed ? 1 : 0) << k;
      ASSERT_EQ(other.at(last, Column::force_state), armed ? 0 : 1) << k;
      pushed += other.vec(last, Column::motor_torque).norm();
    }
    EXPECT_EQ(pushed > 0, armed);
    input.force = ForceRequest::arm;
    for (int k = 0; k < 700; ++k) tick(true);
    EXPECT_EQ(other.at(other.size() - 1, Column::force_wanted), 1);
    EXPECT_GT(other.vec(other.size() - 1, Column::motor_torque).norm(), 0);
  }
}

// A lane of its own settings: what it says of itself while it comes and goes.
TEST(SecondRun, ComesAndGoesWithTheSwitch) {
  const RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  const Vec3 target = plan.hand.at(0);
  Rig first(plan.arm, plan.document.scene);
  first.start(plan.parameters, rest_at(plan.arm, target));
  FurtherLane second;
  second.open(std::make_unique<Rig>(plan.arm, plan.document.scene));
  second.room_for(first);
  test::Rows one(first.layout());
  std::vector<double> other(static_cast<std::size_t>(first.layout().stride()), 77);
  Parameters p = plan.parameters;
  p.kind = CouplingKind::standard;
  const RigInput input{.hand = {target + Vec3(0.01, 0.01, 0), 1}};
  const auto tick = [&](bool on) {
    first.step(plan.parameters, input, one.add());
    second.step(on, p, first, input, other);
  };
  const auto in_other = [&](Column c) {
    return first.layout().in(std::span<const double>(other), c);
  };
  tick(false);
  EXPECT_FALSE(second.runs() || second.changed());
  EXPECT_EQ(other[0], 77) << "a row that was never its own";
  for (int k = 0; k < 20; ++k) tick(true);
  EXPECT_TRUE(second.runs());
  EXPECT_FALSE(second.changed());
  EXPECT_EQ(second.parameters(), p);
  EXPECT_EQ(in_other(Column::kind)[0], static_cast<double>(CouplingKind::standard));
  EXPECT_NEAR(in_other(Column::time)[0], 19 * plan.parameters.tick, 1e-12) << "since it began";
  p.k_vc = 8;
  tick(true);
  EXPECT_TRUE(second.changed());
  EXPECT_EQ(second.parameters().k_vc, 8);
  tick(true);
  EXPECT_FALSE(second.changed());
  const auto apart = [&] {
    double most = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      most = std::max(
          most,
          std::abs(in_other(Column::device_position)[j] -
                   one.vec(one.size() - 1, Column::device_position)[static_cast<Eigen::Index>(j)]));
    }
    return most;
  };
  for (int k = 0; k < 50; ++k) tick(true);
  EXPECT_GT(apart(), 1e-9) << "another law";
  second.begin_anew();
  tick(true);
  EXPECT_EQ(in_other(Column::time)[0], 0);
  EXPECT_LT(apart(), 1e-3) << "a tick after the first one's place";
  tick(false);
  EXPECT_FALSE(second.runs());
  for (const double number : other) EXPECT_TRUE(std::isnan(number));
  tick(true);
  EXPECT_TRUE(second.runs());
  second.close();
  EXPECT_FALSE(second.runs());
}

}  // namespace
}  // namespace limpid
