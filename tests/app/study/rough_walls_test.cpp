#include <gtest/gtest.h>

#include "app/study/friction.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

constexpr RoughWalls kFlat{
    .walls = 1, .stiffness = 1000, .friction_static = 0.4, .friction_kinetic = 0.4};

TEST(Friction, GivesNothingWhereItsSpringIsStretchedAndLetGo) {
  // l = -K_t z, its work over a tick at the end's force, as the implicit rule has it: stretching
  // takes K_t (z' - z)^2 / 2 more than is stored.
  const Vec3 z(1e-4, 0, 0), further(3e-4, 0, 0);
  const Rub before{.normal = 2, .friction = -1000 * z};
  const Rub now{.normal = 2, .friction = -1000 * further, .moved = further - z};
  EXPECT_NEAR(given_by_friction(kFlat, before, now), -1000 * 4e-8 / 2, 1e-15);
}

TEST(Friction, TakesItsForceTimesTheWayWhereItSlips) {
  const Rub slipping{.normal = 2, .friction = Vec3(-0.8, 0, 0), .moved = Vec3(1e-3, 0, 0)};
  EXPECT_NEAR(given_by_friction(kFlat, slipping, slipping), -0.8e-3, 1e-15);
}

TEST(Friction, ThatPushesAlongTheMotionWouldBeSeenToGive) {
  const Rub wrong{.normal = 2, .friction = Vec3(0.8, 0, 0), .moved = Vec3(1e-3, 0, 0)};
  EXPECT_GT(given_by_friction(kFlat, wrong, wrong), 7e-4);
}

TrialResult run(const Trial& trial) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  return TrialRunner("walls", options).run({trial}).front();
}

// Pressed into a corner, each wall is found to push with its own force.
TEST(RoughWalls, AreToldApartByTheirForces) {
  RoughWalls corner{.walls = 3, .stiffness = 2000, .friction_static = 0.5, .friction_kinetic = 0.5};
  Parameters p;
  p.kind = CouplingKind::predictive;
  const Vec3 in = Vec3(1, 2, -1.5).normalized();
  const auto at = [&](double t) {
    return Vec3(kMeet + (0.015 * minimum_jerk(t / 0.2) - 0.002) * in);
  };
  const Trial trial = rubbing("corner", corner, hand_path("into the corner", p.tick, 0.5, at), p);
  const TrialResult result = run(trial);
  const std::vector<Rub> rubs = rubs_of(trial, corner, result.session).back();
  ASSERT_EQ(rubs.size(), 3u);
  const Vec3 tip =
      tip_at(trial.plan.arm,
             Eigen::Map<const Eigen::Vector3d>(
                 result.session.at(result.session.size() - 2, Column::proxy_position).data()));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(rubs[i].normal, 0.3);
    EXPECT_NEAR(rubs[i].normal, 2000 * kOutward[i].dot(kMeet - tip), 0.01) << i;
    EXPECT_NEAR(rubs[i].friction.dot(kOutward[i]), 0, 1e-12);
    EXPECT_LE(rubs[i].friction.norm(), 0.5 * rubs[i].normal + 1e-9);
  }
}

// From the tick in which it is touched on, the second wall's force is its own.
TEST(RoughWalls, ThatAreNotTouchedDoNotPush) {
  const RoughWalls edge{
      .walls = 2, .stiffness = 2000, .friction_static = 0.5, .friction_kinetic = 0.5};
  Parameters p;
  p.kind = CouplingKind::predictive;
  const auto at = [](double t) {
    return Vec3(kMeet + Vec3(0, 0.02 * minimum_jerk(t / 0.2) - 0.008, 0.004));
  };
  const Trial trial = rubbing("edge", edge, hand_path("beside the edge", p.tick, 0.5, at), p);
  int touched = 0;
  const TrialResult result = run(trial);
  for (const std::vector<Rub>& rubs : rubs_of(trial, edge, result.session)) {
    EXPECT_EQ(rubs[0].normal, 0);
    if (rubs[1].normal == 0) continue;
    ++touched;
    EXPECT_LE(rubs[1].friction.norm(), 0.5 * rubs[1].normal + 1e-9);
  }
  EXPECT_GT(touched, 300);
}

}  // namespace
}  // namespace limpid
