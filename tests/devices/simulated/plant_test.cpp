// Motors, transmission and encoders of the virtual arm against closed forms.
#include "devices/simulated/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/tick/as_taken.h"
#include "tests/support/random_arm.h"
#include "tests/support/wheel.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using test::wheel;
using Vector = Vec<kAnyDof>;

constexpr double kInertia = 3e-4;  // [kg m^2]
constexpr double kTurn = 2 * 3.14159265358979323846;
const HandInput kNoHand{Vec3::Zero(), 0};

// A wheel without a hand and its plant.
struct Wheel {
  explicit Wheel(double x = 0, double v = 0) {
    arm.place(Vector::Constant(1, x), Vector::Constant(1, v), Vec3::Zero());
    plant.place(arm.x(), arm.v());
    p.damping = 0;
  }
  void live(double torque) { plant.live(arm, p, Vector::Constant(1, torque), kNoHand); }
  double x() const { return arm.x()[0]; }
  double v() const { return arm.v()[0]; }
  double shown() const { return plant.encoders(p, arm.x())[0]; }

  VirtualArm<kAnyDof> arm{wheel(kInertia)};
  Plant<kAnyDof> plant{wheel(kInertia)};
  Parameters p;
};

TEST(Plant, IsTheArmItselfByDefault) {
  Random random(71);
  const ArmDescription description = random_arm(4, 71);
  VirtualArm<kAnyDof> bare(description), driven(description);
  Plant<kAnyDof> plant(description);
  const Vector x = random.vector(4, 1), v = random.vector(4, 1);
  const Vec3 tip = bare.tip();
  bare.place(x, v, tip);
  driven.place(x, v, tip);
  plant.place(x, v);
  const Parameters p;
  for (int k = 0; k < 50; ++k) {
    const Vector torque = random.vector(4, 0.1);
    const HandInput hand{tip + random.vector(3, 0.01), 1};
    bare.live(p, torque, hand);
    plant.live(driven, p, torque, hand);
    ASSERT_EQ(driven.x(), bare.x());
    ASSERT_EQ(driven.v(), bare.v());
    ASSERT_EQ(plant.hand_torque(), bare.hand_torque());
    ASSERT_EQ(plant.torque(), torque);
    ASSERT_EQ(plant.encoders(p, driven.x()), driven.x());
  }
}

TEST(Plant, MotorsFollowTheCommandAsAFirstOrderLag) {
  for (const double bandwidth : {50., 300., 2000.}) {
    Wheel wheel;
    wheel.p.current_loop = bandwidth;
    const double w = kTurn * bandwidth, torque = 0.01;
    for (int k = 1; k <= 30; ++k) {
      wheel.live(torque);
      const double t = k * wheel.p.tick, behind = (1 - std::exp(-w * t)) / w;
      ASSERT_NEAR(wheel.v(), torque / kInertia * (t - behind), 1e-9);
      const double before = (1 - std::exp(-w * (t - wheel.p.tick))) / w;
      ASSERT_NEAR(wheel.plant.torque()[0], torque * (wheel.p.tick - behind + before) / wheel.p.tick,
                  1e-12);
    }
  }
}

TEST(Plant, MotorsGiveTheScaleOfWhatTheyAreTold) {
  Wheel wheel;
  wheel.p.torque_scale = 1.3;
  for (int k = 1; k <= 10; ++k) {
    wheel.live(0.01);
    ASSERT_NEAR(wheel.v(), 1.3 * 0.01 / kInertia * k * wheel.p.tick, 1e-9);
  }
}

// After a blow to the motor both ends swing about their common centre. The motor has 0.6 of a
// single joint's inertia, so they swing sqrt(1 + 0.6/0.4) times as fast as the motor on a held
// joint.
TEST(Plant, MotorAndJointSwingOnTheTransmission) {
  for (const double resonance : {20., 60., 150.}) {
    Wheel wheel;
    wheel.p.resonance = resonance;
    wheel.p.tick = 1e-4;
    wheel.p.substeps = 4;
    wheel.live(0.5);
    const double blow = 0.5 * wheel.p.tick;
    const double w = kTurn * resonance, damping = 0.03 * w * 2.5;  // 1/s
    const double swing = std::sqrt(2.5 * w * w - damping * damping);
    const double seen = 6 * kTurn / swing;
    double worst = 0;
    for (double t = wheel.p.tick; t < seen; t += wheel.p.tick) {
      const double half = t - wheel.p.tick / 2;  // since the middle of the blow
      const double apart =
          blow / (0.6 * kInertia) / swing * std::exp(-damping * half) * std::sin(swing * half);
      worst = std::max(worst, std::abs(wheel.shown() - wheel.x() - apart));
      const double centre = 0.6 * wheel.shown() + 0.4 * wheel.x();
      ASSERT_NEAR(centre, blow / kInertia * half, 1e-9) << "momentum is kept";
      wheel.live(0);
    }
    EXPECT_LT(worst, 0.02 * blow / (0.6 * kInertia) / swing) << resonance << " Hz";
  }
}

TEST(Plant, ARigidTransmissionIsTheLimitOfAStiffOne) {
  Wheel stiff, rigid;
  stiff.p.resonance = 1000;
  for (int k = 0; k < 200; ++k) {
    const double torque = 0.01 * std::sin(0.05 * k);
    stiff.live(torque);
    rigid.live(torque);
    ASSERT_NEAR(stiff.x(), rigid.x(), 1e-5);
  }
}

TEST(Plant, LinksKeepPartOfTheInertiaInEveryDirectionOfRandomArms) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const int n = 1 + static_cast<int>(seed % 8);
    const ArmDescription description = random_arm(n, seed);
    VirtualArm<kAnyDof> arm(description);
    Plant<kAnyDof> plant(description);
    Parameters p;
    p.resonance = 80;
    Random random(seed);
    const Vector x = random.vector(n, 0.5);
    arm.place(x, Vector::Zero(n), Vec3::Zero());
    plant.place(x, Vector::Zero(n));
    for (int k = 0; k < 200; ++k) plant.live(arm, p, random.vector(n, 0.01), kNoHand);
    EXPECT_TRUE(arm.x().allFinite() && arm.v().norm() < 1e3) << seed;
  }
}

TEST(Plant, CoggingTakesAndReturnsEnergy) {
  constexpr double kAmplitude = 0.004;
  Wheel wheel(0.01, 3);
  wheel.p.cogging = kAmplitude;
  const auto energy = [&] {
    return kInertia / 2 * wheel.v() * wheel.v() + kAmplitude / 60 * std::cos(60 * wheel.x());
  };
  const double before = energy();
  double slowest = wheel.v();
  for (int k = 0; k < 2000; ++k) {
    wheel.live(0);
    slowest = std::min(slowest, wheel.v());
    ASSERT_NEAR(energy(), before, 1e-3 * before);
  }
  const double highest = kAmplitude / 60;
  EXPECT_NEAR(slowest, std::sqrt(2 / kInertia * (before - highest)), 1e-3) << "over a cog";
}

TEST(Plant, UnknownFrictionHoldsAndResists) {
  Wheel wheel;
  wheel.p.unknown_friction = 0.02;
  for (int k = 0; k < 10; ++k) wheel.live(0.019);
  EXPECT_EQ(wheel.v(), 0);
  for (int k = 1; k <= 10; ++k) {
    wheel.live(0.05);
    ASSERT_NEAR(wheel.v(), (0.05 - 0.02) / kInertia * k * wheel.p.tick, 1e-9);
  }
}

TEST(Plant, EncodersHaveAWrongZeroAndAnEccentricDisc) {
  Wheel wheel(0.37);
  wheel.p.zero_error = -0.05;
  EXPECT_DOUBLE_EQ(wheel.shown(), 0.37 - 0.05);
  wheel.p.eccentricity = 0.004;
  EXPECT_NEAR(wheel.shown(), 0.37 - 0.05 + 0.004 * std::sin(10 * 0.37), 1e-15);
}

TEST(Plant, IsNothingThatARealDeviceTakesOver) {
  Parameters p;
  p.torque_scale = 2;
  p.resonance = 50;
  p.zero_error = 0.1;
  EXPECT_EQ(as_taken(p, {}), Parameters{as_taken(Parameters{}, {})});
}

}  // namespace
}  // namespace limpid
