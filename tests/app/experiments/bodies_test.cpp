#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/experiments/body_bench.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

BodyClaim claim() {
  return {.group = "roll",
          .what = "ball rolls",
          .unit = "m/s^2",
          .expected = 4,
          .measured = 4.1,
          .limit = 3,
          .conditions = "A ball."};
}

TEST(BodyClaim, HasItsErrorInPercentOfWhatIsExpected) {
  EXPECT_NEAR(claim().error(), 2.5, 1e-12);
  const Check check = claim().check();
  EXPECT_EQ(check.what, "ball rolls: error [%]");
  EXPECT_TRUE(check.passed);
  ASSERT_TRUE(check.against);
  EXPECT_EQ(check.against->expected, 4);
  EXPECT_EQ(check.against->measured, 4.1);
  EXPECT_EQ(check.against->conditions, "A ball.");
}

TEST(BodyClaim, FailsForWhatIsLostAsForWhatIsGained) {
  for (const double measured : {3.8, 4.2}) {
    BodyClaim one = claim();
    one.measured = measured;
    EXPECT_TRUE(one.check().failed()) << measured;
  }
  BodyClaim none = claim();
  none.measured = std::nan("");
  EXPECT_TRUE(none.check().failed());
}

TEST(BodyClaim, MayBeOffByAnAmountWhereNothingIsExpected) {
  BodyClaim one = claim();
  one.expected = 0;
  one.measured = -0.3;
  one.limit = 0.2;
  one.relative = false;
  EXPECT_NEAR(one.error(), -0.3, 1e-15);
  EXPECT_EQ(one.check().what, "ball rolls: error [m/s^2]");
  EXPECT_TRUE(one.check().failed());
}

TEST(BodyClaim, IsOnlyMeasuredWhereASentenceSaysWhy) {
  BodyClaim one = claim();
  one.measured = 8;
  one.unjudged = "Nothing foretells it.";
  EXPECT_FALSE(one.check().failed());
  EXPECT_FALSE(one.check().passed);
  EXPECT_EQ(one.check().unjudged, "Nothing foretells it.");
  one.unjudged = "";
  EXPECT_TRUE(one.check().failed());
}

TEST(BodyBench, SetsABodyGoing) {
  Scene scene;
  scene.gravity.setZero();
  scene.add(
      moving("slab", Box{{0.03, 0.05, 0.01}}, 0.05, turned_at({1, 2, 3}, 0.7, {0, 0.6, 0.8})));
  BodyBench bench(scene, 1e-3);
  const Vec3 speed(0.3, -0.2, 0.1), spin(2, 1, -3);
  bench.set_going(0, speed, spin);
  EXPECT_EQ(bench.time(), 0);
  EXPECT_LT((bench.world().speed(0) - speed).norm(), 1e-12);
  EXPECT_LT((bench.world().spin(0) - spin).norm(), 1e-12);
}

TEST(BodyBench, CountsTheEnergyOfSpeedSpinAndWeight) {
  Scene scene;
  const Vec3 moments = ball_moments(0.05, 0.02);
  scene.add(moving("ball", Sphere{0.02}, 0.05, pose_at({0, 0, 2})));
  BodyBench bench(scene, 1e-3);
  EXPECT_NEAR(bench.energy(0, moments), 0.05 * 9.81 * 2, 1e-12);
  bench.run(0.1);  // what falls keeps what it has
  EXPECT_NEAR(bench.world().speed(0).z(), -0.981, 1e-9);
  EXPECT_NEAR(bench.energy(0, moments), 0.05 * 9.81 * 2, 1e-9);
  Scene free = scene;
  free.gravity.setZero();
  BodyBench turning(free, 1e-3);
  turning.set_going(0, Vec3::Zero(), {0, 0, 5});
  EXPECT_NEAR(turning.energy(0, moments), moments.z() * 25 / 2, 1e-6 * moments.z());
  EXPECT_NEAR(turning.angular_momentum(0, moments).z(), moments.z() * 5, 1e-6 * moments.z());
}

// README's table of errors is far inside the limits, by kinds of motion and units.
struct BodyError {
  const char *group, *unit;
  double most;
};
constexpr BodyError kBodyErrors[] = {
    {"slide", "m/s^2", 1e-6}, {"slide", "mm", 1e-6},   {"roll", "m/s^2", 0.1}, {"hit", "N s", 1e-9},
    {"hit", "m/s", 0.025},    {"tip", "degrees", 0.6}, {"swing", "s", 0.005},  {"swing", "J", 1e-9},
    {"top", "rad/s", 0.05},   {"spin", "s", 0.02},     {"drawer", "mm", 1e-3}};

// Conditions that a claim names.
constexpr std::pair<const char*, const char*> kBodyConditions[] = {
    {"block slides", "a block of 40 x 40 x 10 mm and 100 g, measured from 0.2 to 0.8 s"},
    {"block rests", "Friction 0.5, a block of 40 x 40 x 10 mm"},
    {"ball rolls", "radius 20 mm, 50 g, friction 0.9, measured from 0.2 to 1 s"},
    {"pendulum on a hinge, amplitude 0.1 rad, tick 1 ms: energy",
     "The energy of the swing is "
     "0.123 mJ"},
    {"pendulum on a ball joint, amplitude 2.5 rad, tick 1 ms: energy",
     "The energy of the swing is 44.2 mJ"},
    {"spinning top with 100 rad/s, tick 1 ms: energy", "which is 0.811 J at the start"},
    {"chain of three", "with an energy of 110 mJ"}};

void expect_as_read(const BodyClaim& claim) {
  for (const auto& [group, unit, most] : kBodyErrors) {
    if (claim.group != group || claim.unit != unit) continue;
    EXPECT_LE(std::abs(claim.error()), most) << claim.what;
  }
  for (const auto& [begin, words] : kBodyConditions) {
    if (claim.what.starts_with(begin)) {
      EXPECT_THAT(claim.conditions, HasSubstr(words)) << claim.what;
    }
  }
  if (claim.what.starts_with("dominoes")) {
    EXPECT_NEAR(claim.measured, 0.87, 0.05);
    EXPECT_FALSE(claim.expected);
  }
}

// The quick cases, under the usual tick: no claim fails.
TEST(BodyCases, HoldWhatTheyClaim) {
  std::size_t judged = 0;
  for (const auto& cases : {cases_with_contacts(), cases_with_joints()}) {
    for (const BodyCase& one : cases) {
      if (!one.quick) continue;
      for (const BodyClaim& claim : one.find(1e-3).claims) {
        EXPECT_FALSE(claim.check().failed()) << claim.what << ": " << claim.error();
        EXPECT_FALSE(claim.conditions.empty()) << claim.what;
        expect_as_read(claim);
        judged += claim.unjudged.empty();
      }
    }
  }
  EXPECT_GT(judged, 30u);
}

}  // namespace
}  // namespace limpid
