// Paths of hands that an arm cannot follow, and why.
#include "app/run/reach_check.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/dynamics/inverse_kinematics.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

// The built-in arm's links are 0.135 m long each, and its first two axes meet in the origin.
TEST(ReachCheck, NamesTheFirstPointThatIsTooFarAway) {
  RunPlan plan = test::plan("free.toml", "touch.csv", 1);
  EXPECT_EQ(out_of_reach(plan), "");
  plan.hand = hand_through({0, 0.5, 1, 1.5},
                           {Vec3(0.19, 0, 0), Vec3(0.16, 0.12, 0.15), Vec3(2, 0, 0), Vec3(3, 0, 0)},
                           "my hand");
  EXPECT_NEAR(reach(plan.arm), 0.27, 1e-9);
  EXPECT_EQ(out_of_reach(plan),
            "my hand: the point at 1.000 s is 2.0000 m from the first joint; the arm omni reaches "
            "0.2700 m");
  plan.hand.position[0] = Vec3(0, 0.3, 0);
  EXPECT_EQ(out_of_reach(plan),
            "my hand: the point at 0.000 s is 0.3000 m from the first joint; the arm omni reaches "
            "0.2700 m");
  plan.hand.position = {Vec3(0.19, 0, 0), Vec3(0.27, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, -0.27)};
  EXPECT_EQ(out_of_reach(plan), "") << "stretched out is in reach";
}

// The arm turns by at most 1 rad to either side: no point behind it can be the first.
TEST(ReachCheck, WantsTheFirstPointWithinTheLimitsOfTheJoints) {
  RunPlan plan = test::plan("free.toml", "touch.csv", 1);
  plan.hand = hand_through({0, 1}, {Vec3(-0.19, 0.01, 0), Vec3(0.19, 0, 0)}, "behind");
  EXPECT_EQ(out_of_reach(plan),
            "behind: the first point (-0.1900, 0.0100, 0.0000) m is out of reach of the arm omni "
            "within its joint limits");
  plan.start = rest_at(plan.arm, Vec3(0.19, 0, 0));
  EXPECT_EQ(out_of_reach(plan), "") << "it starts elsewhere";
}

}  // namespace
}  // namespace limpid
