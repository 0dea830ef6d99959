// Bounds for moving bodies in every scene, set before bodies were built.
#include <gtest/gtest.h>

#include "core/dynamics/random.h"
#include "tests/support/body_scenes.h"

namespace limpid::test {
namespace {

Parameters predictive(double eta, double encoder_step = 0) {
  Parameters p;
  p.kind = CouplingKind::predictive;
  p.eta = eta;
  p.encoder_step = encoder_step;
  return p;
}

class BodyScenes : public testing::TestWithParam<double> {};  // stiffness [N/m]

TEST_P(BodyScenes, GiveNothingAndAreQuietWithExactEncoders) {
  for (const double eta : {1.0, 0.3}) {
    for (const double mass : {0.005, 0.05, 0.5}) {
      for (const BodyBench& bench : body_benches({mass, GetParam()})) {
        SCOPED_TRACE(bench.name + " of " + std::to_string(mass) + " kg, eta " +
                     std::to_string(eta));
        const BodyRun r = run(bench, predictive(eta));
        EXPECT_FALSE(r.diverged);
        EXPECT_LE(r.energy, bench.name == "drop" ? 5e-4 : 5e-5);
        EXPECT_LE(r.beyond, 5e-5);
        EXPECT_LE(r.gain, 1e-6);
        EXPECT_LE(r.chatter, 1e-4);
        EXPECT_GT(r.moved, 0.004);  // the scene did happen
      }
    }
  }
}

TEST_P(BodyScenes, GiveLittleWithEncodersOfFineSteps) {
  for (const double eta : {1.0, 0.3}) {
    for (const double mass : {0.005, 0.05, 0.5}) {
      for (const BodyBench& bench : body_benches({mass, GetParam()})) {
        SCOPED_TRACE(bench.name + " of " + std::to_string(mass) + " kg, eta " +
                     std::to_string(eta));
        const BodyRun r = run(bench, predictive(eta, 1e-4));
        EXPECT_FALSE(r.diverged);
        EXPECT_LE(r.energy, 1e-2);
        EXPECT_LE(r.beyond, 1.5e-3);
        EXPECT_LE(r.gain, 1e-6);
        EXPECT_LE(r.chatter, 2e-2);
        EXPECT_GE(r.governor, 1);
      }
    }
  }
}

TEST_P(BodyScenes, LeaveTheLedgerAsItWasWhenABlockFalls) {
  const BodyRun r = run(with_tip(drop({0.05, GetParam()})), predictive(1));
  EXPECT_GE(r.reserve, -1e-4);
  EXPECT_EQ(r.governor, 1);
  EXPECT_GT(r.hardest, 1);
}

INSTANTIATE_TEST_SUITE_P(Stiffnesses, BodyScenes, testing::Values(600, 2000, 5000));

// Between tip and wall a light body's forces depend on each other most, and the motors meet their
// limit. All but a few ticks have a solution.
TEST(LightBody, IsSqueezedWithoutTheProxyStandingStill) {
  for (const double step : {0.0, 1e-4}) {
    for (const double mass : {0.0005, 0.005}) {
      for (const double stiffness : {2000.0, 5000.0}) {
        const BodyRun r = run(with_tip(squeeze({mass, stiffness})), predictive(1, step));
        EXPECT_LE(r.stood_still, mass < 0.001 ? 10 : 0) << mass << " " << stiffness << " " << step;
        EXPECT_GT(r.limited, 1000) << "ticks with a motor at its limit";
        EXPECT_GE(r.reserve, -1e-3);
      }
    }
  }
}

TEST(LightBody, HangsOnAStiffMagnet) {
  const BodyRun r = run(with_tip(magnet({.mass = 1e-4, .stiffness = 20000})), predictive(1));
  EXPECT_FALSE(r.diverged);
  EXPECT_LE(r.energy, 5e-5);
  EXPECT_LE(r.beyond, 5e-5);
  EXPECT_GT(r.moved, 0.01);
}

// Rms difference of the hand's force from the same program's at 20 kHz, averaged over 20 of its
// ticks [N]: along y, the direction of the push, or of the whole force.
double off_a_fast_run(const BodyBench& bench, bool along_y) {
  const Parameters p = predictive(1);
  Parameters fast = p;
  fast.tick = p.tick / 20;
  fast.substeps = p.substeps / 20;
  const BodyRun r = run(bench, p), reference = run(bench, fast);
  double sum = 0;
  for (std::size_t k = 0; k < r.hand.size(); ++k) {
    Vec3 off = r.hand[k];
    for (std::size_t i = 0; i < 20; ++i) off -= reference.hand[20 * k + i] / 20;
    sum += along_y ? off.y() * off.y() : off.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(r.hand.size()));
}

// Bodies that stick across a push depend on their history, so nothing is compared across it. The
// door has no friction, as it would swing up to its stop at once.
TEST(HandsForce, IsThatOfALoopOf20Kilohertz) {
  const BodyKind rough{.mass = 0.05, .stiffness = 2000},
      smooth{.mass = 0.05, .stiffness = 2000, .friction = 0};
  for (const BodyBench& bench : {free_push(rough), push_with_friction(rough), squeeze(rough),
                                 row_of_two(rough), door(smooth), magnet(rough), knob(rough)}) {
    EXPECT_LE(off_a_fast_run(with_tip(bench), bench.name != "magnet" && bench.name != "knob"),
              0.005)
        << bench.name;
  }
  for (const BodyBench& bench : {button(rough, false), button(rough, true), drop(rough)}) {
    EXPECT_LE(off_a_fast_run(with_tip(bench), false), 0.08) << bench.name;
  }
}

TEST(RandomBodies, AreStableAndMakeNothing) {
  Random random(1);
  for (int i = 0; i < 120; ++i) {
    const BodyKind kind{random.log_between(5e-4, 1), random.log_between(300, 10000),
                        random.between(0, 1), random.log_between(3000, 50000)};
    std::vector<BodyBench> benches = body_benches(kind);
    BodyBench& bench = benches[static_cast<std::size_t>(i) % benches.size()];
    bench.grip = random.log_between(100, 5000);
    Parameters p = predictive(random.log_between(0.1, 5), random.one_of({0.0, 5e-5, 1e-4}));
    p.hand_damping = random.between(0, 8);
    p.hand_mass_at_tip = random.one_of({0.0, 0.1, 1.0});
    p.inertia_error = random.log_between(0.5, 2);
    SCOPED_TRACE(bench.name + ", run " + std::to_string(i));
    const BodyRun r = run(bench, p);
    EXPECT_FALSE(r.diverged);
    EXPECT_LE(r.beyond, p.energy);
    EXPECT_LE(r.gain, 1e-6);
  }
}

// Late motors, known to the law or not: up to walls about as stiff as recommended for such a delay,
// and beyond if it is known. There the governors cut the hand's force. The proxy may then give
// bodies energy that the hand has not paid for, but the hand gets no more.
TEST(LateMotorsWithBodies, GiveTheHandNoMoreThanTheLedgerAllows) {
  for (const int delay : {1, 3}) {
    for (const auto& [known, stiffness] :
         {std::pair(true, 600.0), {false, 600.0}, {true, 2000.0}}) {
      for (const BodyBench& bench : body_benches({0.05, stiffness})) {
        SCOPED_TRACE(bench.name + ", " + std::to_string(delay) + (known ? " known" : " unknown"));
        Parameters p = predictive(1);
        p.device_delay = delay;
        if (known) p.delay = delay;
        const BodyRun r = run(bench, p);
        EXPECT_FALSE(r.diverged);
        EXPECT_LE(r.given, p.energy);
        EXPECT_LE(r.gain, 1e-6);
        if (stiffness == 600) {
          EXPECT_LE(r.beyond, p.energy);
        }
      }
    }
  }
}

}  // namespace
}  // namespace limpid::test
