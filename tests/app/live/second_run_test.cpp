// The second run beside the loop's, tick by tick.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace limpid
