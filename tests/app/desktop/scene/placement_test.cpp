#include "app/desktop/scene/placement.h"

#include <gmock/gmock.h>

#include "render/scene_items.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

Workplace desk() {
  Workplace at;
  at.base = Vec3(0, 0, 0.05);
  at.reach = 0.27;
  at.rest = Vec3(0.2, 0, 0);
  at.tips = {at.rest, at.rest};
  return at;
}

Scene table(double height) {
  Scene scene;
  scene.add({"top", pose_at(Vec3(0.2, 0, height)), Plane{Vec3::UnitZ()}, 600});
  return scene;
}

TEST(HandyScale, KeepsWhatFitsAHand) {
  for (const double extent : {0.02, 0.05, 0.1, 0.2}) EXPECT_EQ(handy_scale(extent), 1);
}

TEST(HandyScale, MakesTheRestAboutEightCentimetres) {
  for (const double extent : {1e-6, 0.001, 0.0199, 0.201, 1.0, 155.0, 1e7}) {
    EXPECT_NEAR(handy_scale(extent) * extent, 0.08, 0.005) << extent;
  }
}

TEST(HandyScale, IsOneForWhatHasNoSize) {
  for (const double extent : {0.0, -1.0, std::nan(""), HUGE_VAL}) EXPECT_EQ(handy_scale(extent), 1);
}

TEST(TableHeight, IsThatOfTheHighestLevelPlaneBelowTheTip) {
  Scene scene = table(-0.04);
  scene.add(table(-0.1).objects[0]);
  scene.add(table(0.1).objects[0]);
  scene.add({"wall", pose_at(Vec3(0.1, 0, -0.01)), Plane{Vec3::UnitX()}, 600});
  EXPECT_EQ(table_height(scene, Vec3(0.2, 0, 0)), -0.04);
  EXPECT_EQ(table_height({}, Vec3(0.2, 0, 0)), std::nullopt);
}

TEST(Place, IsInReachAndNeverAroundATipOrAnotherObject) {
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    Workplace at = desk();
    for (Vec3& tip : at.tips) tip += random.point(0.05);
    const Vec3 other = at.rest + random.point(0.1);
    at.taken.push_back(Bounds(other - Vec3::Constant(0.02), other + Vec3::Constant(0.02)));
    const Vec3 size = Vec3::Constant(0.05) + random.point(0.04);
    const bool on_table = i % 2 == 0;
    const Vec3 place = find_place(size, on_table ? std::optional(-0.04) : std::nullopt, at);
    const Bounds box(place - size / 2, place + size / 2);
    for (const Vec3& tip : at.tips) EXPECT_GT(box.exteriorDistance(tip), 0.005) << i;
    EXPECT_FALSE(box.intersects(at.taken[0])) << i;
    EXPECT_LT((place - at.base).norm(), at.reach) << i;
    if (on_table) {
      EXPECT_NEAR(box.min().z(), -0.04, 1e-12);
    } else {
      EXPECT_EQ(place.z(), at.rest.z());
    }
  }
}

// A cube of 4 cm stands 1.2 cm clear of a tip at rest: its middle is 3.2 cm in front of the tip.
// This is nearer to the wanted point, 1 cm in front of the tip, than any place beside or behind.
TEST(Place, IsInFrontOfTheTipWhicheverWayTheArmPoints) {
  for (const double angle : {0.0, 1.2, 3.0}) {
    const Vec3 forward(std::cos(angle), std::sin(angle), 0), left(-forward.y(), forward.x(), 0);
    Workplace at;
    at.reach = 0.5;
    at.rest = 0.2 * forward;
    const Vec3 place = find_place(Vec3::Constant(0.04), -0.04, at) - at.rest;
    const double steps = (0.6 * 0.5 + 0.04) / 30;  // between the places that are tried
    // Around a turned arm the corners of the free space are reached first.
    EXPECT_GT(place.dot(forward), angle == 0 ? 0.032 : 0.02) << angle;
    EXPECT_LT(place.head<2>().norm(), 0.032 * std::sqrt(2) + steps) << angle;
    EXPECT_LT(std::abs(place.dot(left)), angle == 0 ? 1e-9 : 0.03) << angle;
    EXPECT_NEAR(place.z(), -0.02, 1e-12) << "it stands";
  }
}

TEST(Place, LeavesAGapToOthersAndIsNotInTheArm) {
  test::Random random(5);
  for (int i = 0; i < 100; ++i) {
    Workplace at = desk();
    const Vec3 other = at.rest + Vec3(0.06, 0, 0) + random.point(0.02);
    at.taken.push_back(Bounds(other - Vec3::Constant(0.02), other + Vec3::Constant(0.02)));
    const Vec3 size = Vec3::Constant(0.03);
    const Vec3 place = find_place(size, std::nullopt, at);
    const Bounds box(place - size / 2, place + size / 2);
    EXPECT_GE(box.exteriorDistance(at.taken[0]), 0.004 - 1e-12) << i;
    for (int part = 1; part < 8; ++part) {
      EXPECT_FALSE(box.contains(at.base + part / 8.0 * (at.rest - at.base))) << i;
    }
    EXPECT_GE(box.exteriorDistance(at.rest), 0.012 - 1e-12) << i;
  }
}

// A place beyond the arm's reach is useless, even if the front is taken.
TEST(Place, StaysInReachWhereTheFrontIsTaken) {
  Workplace at = desk();
  at.taken.push_back(Bounds(Vec3(0.2, -0.1, -0.05), Vec3(0.6, 0.1, 0.05)));
  const Vec3 size = Vec3::Constant(0.03);
  const Vec3 place = find_place(size, -0.04, at);
  EXPECT_LT((place - at.base).norm(), at.reach);
  EXPECT_FALSE(Bounds(place - size / 2, place + size / 2).intersects(at.taken[0]));
}

TEST(Place, OfAModelIsUprightOnTheTable) {
  // glTF's y is up: 10 m tall, 4 m deep, away from its origin.
  const Bounds model(Vec3(3, 5, 1), Vec3(6, 15, 5));
  Object object{.shape = Mesh{.y_up = true}};
  place_mesh(object, model, table(-0.04), desk());
  const Mesh& mesh = std::get<Mesh>(object.shape);
  const Bounds stands =
      moved(model, Eigen::Affine3d(mesh.stood(object.pose)) * Eigen::Scaling(mesh.size()));
  EXPECT_NEAR(stands.sizes().z(), 0.08, 1e-3);
  EXPECT_NEAR(stands.sizes().x(), 0.024, 1e-3);
  EXPECT_NEAR(stands.sizes().y(), 0.032, 1e-3);
  EXPECT_NEAR(stands.min().z(), -0.04, 1e-12);
  EXPECT_GT(stands.exteriorDistance(desk().rest), 0.005);
  EXPECT_LT((stands.center() - desk().base).norm(), desk().reach);
}

TEST(Place, OfAScanThatGoesAroundTheWholeRoomStillIsOne) {
  Workplace at = desk();
  const Vec3 size(0.2, 0.2, 0.2);
  const Vec3 place = find_place(size, std::nullopt, at);
  const Bounds box(place - size / 2, place + size / 2);
  EXPECT_GT(box.exteriorDistance(at.rest), 0.005);
}

}  // namespace
}  // namespace limpid
