#include <gtest/gtest.h>

#include "app/experiments/friction.h"
#include "tests/support/temp_dir.h"

namespace limpid {

Outcome friction(TrialRunner& lab);  // in the table of experiments

namespace {

constexpr RoughWalls kFlat{
    .walls = 1, .stiffness = 1000, .friction_static = 0.4, .friction_kinetic = 0.4};

TEST(Friction, GivesNothingWhereItsSpringIsStretchedAndLetGo) {
  // l = -K_t z: work over a tick at the end's force, by the implicit rule. Stretching takes K_t (z'
  // - z)^2 / 2 more than is stored.
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

// The spring of friction is as stiff as the wall, and never stiffer than 2000 N/m.
TEST(Friction, KnowsHowStiffItsSpringIs) {
  const RoughWalls stiff{.stiffness = 3000, .friction_static = 0.4, .friction_kinetic = 0.4};
  const Rub before{.normal = 2};
  const Rub now{.normal = 2, .friction = Vec3(-0.2, 0, 0), .moved = Vec3(1e-4, 0, 0)};
  EXPECT_NEAR(slipped(stiff, before, now), 0, 1e-12) << "0.2 N are 0.1 mm at 2000 N/m";
  EXPECT_NEAR(slipped(kFlat, before, now), 1e-4, 1e-12) << "and 0.2 mm at 1000 N/m";
  EXPECT_NEAR(given_by_friction(stiff, before, now), -0.2e-4 + 0.04 / 4000, 1e-12);
}

TrialResult run(const Trial& trial) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  return TrialRunner("walls", options).run({trial}).front();
}

// A tip pressed into a corner: each wall is found to push with its own force.
TEST(RoughWalls, AreToldApartByTheirForces) {
  RoughWalls corner{.walls = 3, .stiffness = 2000, .friction_static = 0.5, .friction_kinetic = 0.5};
  Parameters p;
  p.kind = CouplingKind::predictive;
  const Vec3 in = Vec3(1, 2, -1.5).normalized();
  const auto at = [&](double t) {
    return Vec3(kMeet + (0.015 * minimum_jerk(t / 0.2) - 0.002) * in);
  };
  const Trial trial = rubbing(built_in_arm().description, "corner", corner,
                              hand_path("into the corner", p.tick, 0.5, at), p);
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

// Motion along a wall is the tip's, without its part into the wall.
TEST(RoughWalls, AreRubbedByWhatTheTipMovesAlongThem) {
  const RoughWalls flat{.stiffness = 1000, .friction_static = 0.2, .friction_kinetic = 0.2};
  Parameters p;
  p.kind = CouplingKind::predictive;
  const auto at = [](double t) {
    return Vec3(kMeet + Vec3(0, 0.02 * minimum_jerk((t - 0.2) / 0.3),
                             0.005 - 0.015 * minimum_jerk(t / 0.2)));
  };
  const Trial trial = rubbing(built_in_arm().description, "flat", flat,
                              hand_path("over the floor", p.tick, 0.6, at), p);
  const TrialResult result = run(trial);
  const auto tip = [&](std::size_t k) {
    const auto x = result.session.at(k, Column::proxy_position);
    return tip_at(trial.plan.arm, Eigen::Map<const Eigen::Vector3d>(x.data()));
  };
  const auto rubs = rubs_of(trial, flat, result.session);
  Vec3 way = Vec3::Zero();
  std::size_t first = 0;
  while (rubs[first][0].normal == 0) ++first;
  for (std::size_t k = first; k < rubs.size(); ++k) {
    ASSERT_GT(rubs[k][0].normal, 0) << k;
    EXPECT_EQ(rubs[k][0].moved.z(), 0);
    way += rubs[k][0].moved;
  }
  const Vec3 went = tip(rubs.size()) - tip(first);
  EXPECT_NEAR(way.y(), went.y(), 2e-4) << "tick by tick the Jacobian's, of about 20 mm";
  EXPECT_GT(went.y(), 0.01);
}

// The caption describes the hands: 3 N onto a plane of 1000 N/m, 30 mm aside and back; 5 N into an
// edge and a corner of 3000 N/m.
TEST(FrictionExperiment, PressesAndDragsAsItsCaptionSays) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  TrialRunner lab("friction", options);
  friction(lab);
  const auto session = [&](const std::string& start) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(temp / ".")) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(start) && name.ends_with(".h5")) return read_session(entry.path());
    }
    throw std::runtime_error("no session of " + start);
  };
  const auto target = [](const Session& s, double t) {
    const auto at =
        s.at(static_cast<std::size_t>(std::lround(t / s.info.tick)), Column::hand_target);
    return Vec3(at[0], at[1], at[2]);
  };
  const Session smooth = session("drag-0-0");
  // Without friction only the hand's spring of 300 N/m presses.
  EXPECT_NEAR(target(smooth, 0.5).z(), kMeet.z() - 3.0 / 300 - 3.0 / 1000, 1e-6);
  EXPECT_NEAR(target(smooth, 2.0).y(), 0.03, 1e-6);
  EXPECT_NEAR(target(smooth, 3.49).y(), 0, 1e-6);
  const auto force = smooth.at(600, Column::contact_force);
  EXPECT_NEAR(std::hypot(force[0], force[1], force[2]), 3, 0.15);
  for (const auto& [name, walls] : {std::pair("edge-0.5", 2), std::pair("corner-0.5", 3)}) {
    const Session s = session(name);
    const double grip = s.at(0, Column::eta)[0] == 1 ? 3000 : 300;  // [N/m]
    const Vec3 in = kMeet - target(s, 0.3);
    EXPECT_NEAR(in.norm(), 5 / grip + 5.0 / 3000, 1e-6) << name;
    for (int i = 0; i < walls; ++i) {
      EXPECT_NEAR(kOutward[i].dot(in), in.norm() / std::sqrt(walls), 1e-6) << name << " wall " << i;
    }
  }
}

// From the tick of its contact on, the second wall's force is its own.
TEST(RoughWalls, ThatAreNotTouchedDoNotPush) {
  const RoughWalls edge{
      .walls = 2, .stiffness = 2000, .friction_static = 0.5, .friction_kinetic = 0.5};
  Parameters p;
  p.kind = CouplingKind::predictive;
  const auto at = [](double t) {
    return Vec3(kMeet + Vec3(0, 0.02 * minimum_jerk(t / 0.2) - 0.008, 0.004));
  };
  const Trial trial = rubbing(built_in_arm().description, "edge", edge,
                              hand_path("beside the edge", p.tick, 0.5, at), p);
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
