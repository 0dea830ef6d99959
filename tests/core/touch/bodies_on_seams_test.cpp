// Bodies that roll over the seams of level solids: as on one solid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/body_worlds.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

// A box along x whose top is at a height.
Object board(double from, double to, double top) {
  Object o;
  o.shape = Box{Vec3(to - from, 0.2, 0.02)};
  o.pose = pose_at({(from + to) / 2, 0, top - 0.01});
  o.material = {2000, 0, 0.6, 0.6};
  return o;
}

// Boxes side by side along x, from -0.2 to 0.2 m, whose tops are at 0.
void add_tiles(Scene& scene, const std::vector<double>& seams) {
  for (std::size_t i = 0; i + 1 < seams.size(); ++i) {
    scene.add(board(seams[i], seams[i + 1], 0));
  }
}

struct Roll {
  double acceleration = 0;                    // [m/s^2]
  double least = HUGE_VAL, most = -HUGE_VAL;  // height, once it has sunk in [m]
  double aside = 0;                           // [m]
};

Roll roll(const Scene& scene, int ticks) {
  BodyWorld world(scene);
  const Vec3 start = world.pose(0).translation();
  Roll r;
  for (int k = 0; k < ticks; ++k) {
    test::run(world, 1);
    const Vec3 now = world.pose(0).translation();
    r.aside = std::max(r.aside, std::abs(now.y() - start.y()));
    if (k < 100) continue;
    r.least = std::min(r.least, now.z());
    r.most = std::max(r.most, now.z());
  }
  const double t = ticks * test::kTick;
  r.acceleration = 2 * (world.pose(0).translation().x() - start.x()) / (t * t);
  return r;
}

// At rest on its floor, so that the way has no drop in it.
Vec3 resting(double x, double y, double radius, double mass) {
  return {x, y, radius - mass * 9.7 / Body{}.contact_stiffness};
}

TEST(BodiesOnSeams, BallsRollAsOnOneBox) {
  Random random(20261201);
  for (int run = 0; run < 12; ++run) {
    const double mass = random.between(0.01, 0.05), r = random.between(0.006, 0.02);
    std::vector<double> seams{-0.2, 0.2};
    for (int i = 0; i < 4; ++i) seams.push_back(random.between(-0.08, 0.1));
    std::ranges::sort(seams);
    const Vec3 at = resting(-0.12, random.between(-0.05, 0.05), r, mass);
    std::vector<Roll> rolls;
    for (const std::vector<double>& tiles : {std::vector<double>{-0.2, 0.2}, seams}) {
      Scene scene;
      scene.gravity = Vec3(1.5, 0, -9.7);
      add_tiles(scene, tiles);
      scene.add(test::body("ball", Sphere{r}, mass, at, 0.6));
      rolls.push_back(roll(scene, 600));
    }
    SCOPED_TRACE(testing::Message() << "mass " << mass << ", radius " << r);
    EXPECT_NEAR(rolls[1].acceleration, 5.0 / 7 * 1.5, 0.005 * 5 / 7 * 1.5);
    EXPECT_NEAR(rolls[1].acceleration, rolls[0].acceleration, 1e-4);
    EXPECT_LT(rolls[1].most - rolls[1].least, rolls[0].most - rolls[0].least + 2e-6);
    EXPECT_LT(rolls[1].aside, 1e-6);
  }
}

// Edges that are no seams are felt: a step up holds the ball back, a gap bears it on both sides.
TEST(BodiesOnSeams, EdgesThatStandOutStay) {
  const double r = 0.01, mass = 0.02;
  Scene step;
  step.gravity = Vec3(1.5, 0, -9.7);
  add_tiles(step, {-0.2, 0});
  step.add(board(0, 0.2, 0.004));
  step.add(test::body("ball", Sphere{r}, mass, resting(-0.02, 0, r, mass), 0.6));
  BodyWorld world(step);
  test::run(world, 1000);
  EXPECT_LT(world.pose(0).translation().x(), 0) << "1.5 of 9.8 m/s^2 take it up no step of 4 mm";

  Scene gap;
  gap.gravity = Vec3(0, 0, -9.7);
  add_tiles(gap, {-0.2, -0.006});
  add_tiles(gap, {0.006, 0.2});
  gap.add(test::body("ball", Sphere{r}, mass, Vec3(0, 0, r), 0.6));
  BodyWorld between(gap);
  test::run(between, 1000);
  // On both edges: 6 mm aside and 8 mm below its centre.
  EXPECT_NEAR(between.pose(0).translation().z(), 0.008, 2e-4);
  EXPECT_NEAR(between.pose(0).translation().x(), 0, 1e-5);
}

}  // namespace
}  // namespace limpid
