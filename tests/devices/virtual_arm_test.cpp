// The virtual device against motions known by other means.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/math/eigen.h"
#include "devices/simulated/virtual_device.h"
#include "tests/support/random_arm.h"
#include "tests/support/wheel.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using test::wheel;
using Vector = Vec<kAnyDof>;
using AnyArm = VirtualArm<kAnyDof>;

Vector one(double value) { return Vector::Constant(1, value); }
const HandInput kNoHand{Vec3::Zero(), 0};

TEST(VirtualArm, CoastsUnderItsDampingExponentially) {
  constexpr double m = 3e-4, b = 0.012;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = b;
  arm.place(one(0), one(5), Vec3::Zero());
  for (int k = 1; k <= 100; ++k) {
    arm.live(p, one(0), kNoHand);
    const double decay = std::exp(-b / m * k * p.tick);
    ASSERT_NEAR(arm.v()[0], 5 * decay, 1e-4);
    ASSERT_NEAR(arm.x()[0], 5 * m / b * (1 - decay), 1e-6);
  }
}

TEST(VirtualArm, AcceleratesUnderAConstantTorqueAsAParabola) {
  constexpr double m = 3e-4;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  arm.place(one(0.2), one(0), Vec3::Zero());
  for (int k = 1; k <= 100; ++k) {
    arm.live(p, one(0.01), kNoHand);
    const double t = k * p.tick;
    ASSERT_NEAR(arm.x()[0], 0.2 + 0.5 * 0.01 / m * t * t, 1e-12);
  }
}

TEST(VirtualArm, SwingsInAGripForeverAsASpringDoes) {
  // Small swings: the tip's spring of 300 N/m at 1 m is 300 N m/rad.
  constexpr double m = 0.02, k_h = 300, amplitude = 1e-4;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  p.hand_stiffness = k_h;
  p.hand_damping = 0;
  p.substeps = 50;
  const double w = std::sqrt(k_h / m);
  arm.place(one(amplitude), one(0), Vec3::UnitX());
  double largest = 0;
  for (int k = 1; k <= 2000; ++k) {
    arm.live(p, one(0), {Vec3::UnitX(), 1});
    if (k <= 200) {
      ASSERT_NEAR(arm.x()[0], amplitude * std::cos(w * k * p.tick), 2e-3 * amplitude);
    }
    if (k > 1800) largest = std::max(largest, std::abs(arm.x()[0]));
  }
  EXPECT_NEAR(largest, amplitude, 1e-2 * amplitude);  // no numerical damping, no growth
}

TEST(VirtualArm, ConvergesWithTheSquareOfItsSubsteps) {
  for (const int n : {2, 3, 7}) {
    const ArmDescription description = random_arm(n, 130);
    Random random(131);
    const Vector x = random.vector(n, 1), v = random.vector(n, 2), torque = random.vector(n, 0.01);
    const auto after = [&](int substeps) {
      AnyArm arm(description);
      Parameters p;
      p.substeps = substeps;
      arm.place(x, v, Vec3::Zero());
      arm.place(x, v, arm.tip());
      Vec3 target = arm.tip();
      for (int k = 0; k < 20; ++k) {
        target += Vec3(1e-4, -2e-4, 1e-4);
        arm.live(p, torque, {target, 1});
      }
      return Vector(arm.x());
    };
    const Vector exact = after(800);
    const double coarse = (after(10) - exact).norm(), fine = (after(20) - exact).norm();
    EXPECT_LT(fine, coarse / 3) << n;  // a quarter
    EXPECT_LT(fine, 1e-4) << n;
  }
}

// The same arm by Runge and Kutta's fourth-order method at 100 kHz.
class ReferenceArm {
 public:
  ReferenceArm(const ArmDescription& description, const Vector& x, const Vec3& target)
      : arm_(description), x_(x), v_(Vector::Zero(x.size())), target_(target) {}

  void live(const Parameters& p, const Vector& torque, const Vec3& target) {
    constexpr int kSteps = 100;
    const double h = p.tick / kSteps;
    const Vec3 rate = (target - target_) / p.tick;
    const auto a = [&](double t, const Vector& x, const Vector& v) {
      return acceleration(p, torque, target_ + t * rate, rate, x, v);
    };
    for (int i = 0; i < kSteps; ++i) {
      const double t = i * h;
      const Vector a1 = a(t, x_, v_);
      const Vector v2 = v_ + h / 2 * a1, a2 = a(t + h / 2, x_ + h / 2 * v_, v2);
      const Vector v3 = v_ + h / 2 * a2, a3 = a(t + h / 2, x_ + h / 2 * v2, v3);
      const Vector v4 = v_ + h * a3, a4 = a(t + h, x_ + h * v3, v4);
      x_ += h / 6 * (v_ + 2 * v2 + 2 * v3 + v4);
      v_ += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
    target_ = target;
  }
  const Vector& x() const { return x_; }
  const Vector& v() const { return v_; }

 private:
  Vector acceleration(const Parameters& p, const Vector& torque, const Vec3& target,
                      const Vec3& rate, const Vector& x, const Vector& v) const {
    Arm<kAnyDof>::Frames f;
    Mat<kAnyDof> M;
    Vector Cv;
    Jacobian<kAnyDof> J;
    arm_.frames(x, f);
    arm_.inertia_bias(f, v, M, Cv);
    arm_.point_jacobian(f, arm_.dof() - 1, arm_.tip(f), J);
    const Vec3 pull = p.hand_stiffness * (target - arm_.tip(f)) + p.hand_damping * (rate - J * v);
    const Vector whole = torque - Cv - p.damping * v + J.transpose() * pull;
    return least_squares(M, whole);
  }

  Arm<kAnyDof> arm_;
  Vector x_, v_;
  Vec3 target_;
};

TEST(VirtualArm, MovesAsAFineIntegrationDoesToAThousandthOfAnEncodersStep) {
  constexpr double kStep = 4e-4;  // encoder step of the paper's arm [rad]
  for (const int n : {2, 3, 7}) {
    for (const double grip : {0.0, 300.0, 1500.0}) {
      const ArmDescription description = random_arm(n, 137);
      Random random(138);
      const Vector x = random.vector(n, 1);
      Parameters p;
      p.hand_stiffness = grip;
      p.hand_damping = grip / 150;
      p.damping = 0.012;
      AnyArm arm(description);
      arm.place(x, Vector::Zero(n), Vec3::Zero());
      const Vec3 start = arm.tip();
      arm.place(x, Vector::Zero(n), start);
      ReferenceArm reference(description, x, start);
      double fastest = 0, furthest = 0;
      for (int k = 0; k < 300; ++k) {
        const double t = 1e-3 * k;
        Vector torque(n);  // changes every 20 ms, like contacts
        for (int i = 0; i < n; ++i) torque[i] = 0.02 * std::sin(11.0 * (k / 20) + i);
        const Vec3 target = start + 0.01 * Vec3(std::sin(12 * t), std::sin(17 * t), 0);
        arm.live(p, torque, {target, 1});
        reference.live(p, torque, target);
        fastest = std::max(fastest, reference.v().cwiseAbs().maxCoeff());
        furthest = std::max(furthest, (arm.x() - reference.x()).cwiseAbs().maxCoeff());
      }
      EXPECT_GT(fastest, 1) << n;
      EXPECT_LT(furthest, kStep / 1000) << n << " joints, grip " << grip << ", " << fastest;
    }
  }
}

TEST(VirtualArm, SpeaksOfTheHandsMeanTorqueAsItsMomentumDoes) {
  // For one joint, m dv = T (motor + hand - b vbar).
  constexpr double m = 3e-4, b = 0.012;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = b;
  arm.place(one(0.3), one(0), Vec3::UnitX());
  for (int k = 0; k < 300; ++k) {
    const double v = arm.v()[0], x = arm.x()[0];
    arm.live(p, one(0.02), {Vec3(std::cos(0.3), std::sin(0.3 + 0.001 * k), 0), 1});
    const double gained = m * (arm.v()[0] - v) / p.tick;
    const double damped = b * (arm.x()[0] - x) / p.tick;
    ASSERT_NEAR(arm.hand_torque()[0], gained - 0.02 + damped, 1e-9);
  }
}

TEST(VirtualArm, FeelsNoHandThatHasLetGo) {
  Random random(132);
  AnyArm arm(random_arm(3, 132));
  const Parameters p;
  arm.place(random.vector(3, 1), Vector::Zero(3), Vec3::Zero());
  const Vector before = arm.x();
  for (int k = 0; k < 50; ++k) arm.live(p, Vector::Zero(3), {Vec3(1, 2, 3), 0});
  EXPECT_EQ(arm.x(), before);
  EXPECT_EQ(arm.hand_torque().norm(), 0);
}

TEST(VirtualArm, SticksBelowItsFrictionAndSlidesAboveIt) {
  constexpr double m = 3e-4, kFriction = 0.05;
  Parameters p;
  p.damping = 0;
  p.friction = kFriction;
  AnyArm stuck(wheel(m));
  stuck.place(one(0), one(0), Vec3::Zero());
  for (const double tick : {1e-3, 4e-3}) {
    p.tick = tick;
    for (int k = 0; k < 1000; ++k) stuck.live(p, one(0.99 * kFriction), kNoHand);
    EXPECT_EQ(stuck.v()[0], 0);
    EXPECT_EQ(stuck.x()[0], 0);
  }
  p.tick = 1e-3;
  AnyArm sliding(wheel(m));
  sliding.place(one(0), one(0), Vec3::Zero());
  for (int k = 0; k < 100; ++k) sliding.live(p, one(1.5 * kFriction), kNoHand);
  EXPECT_NEAR(sliding.v()[0], 0.5 * kFriction / m * 0.1, 0.02 * 0.5 * kFriction / m * 0.1);
}

TEST(VirtualArm, ComesToRestByFrictionWithoutSwingingBack) {
  constexpr double m = 3e-4, kFriction = 0.05;
  AnyArm arm(wheel(m));
  Parameters p;
  p.damping = 0;
  p.friction = kFriction;
  arm.place(one(0), one(2), Vec3::Zero());
  double last = 2;
  for (int k = 0; k < 200; ++k) {
    arm.live(p, one(0), kNoHand);
    const double v = arm.v()[0];
    ASSERT_GE(v, 0);
    ASSERT_LE(v, last);
    last = v;
  }
  EXPECT_EQ(last, 0);
  // The way is the kinetic energy over the friction.
  EXPECT_NEAR(arm.x()[0], 0.5 * m * 4 / kFriction, 1e-3);
}

// Three slides along directions that are not square to each other: an inertia that does not change,
// but couples them.
ArmDescription skewed_slides(Random& random) {
  ArmDescription arm;
  arm.joints.resize(3);
  arm.links.resize(3);
  for (std::size_t i = 0; i < 3; ++i) {
    arm.joints[i].kind = Joint::Kind::prismatic;
    arm.joints[i].axis = random.direction();
    arm.joints[i].effort = 10;
    arm.joints[i].friction = random.between(0.1, 1);
    arm.links[i].mass = random.log_between(0.02, 0.2);
  }
  return arm;
}

TEST(VirtualArm, IsOnlyEverSlowedByFriction) {
  Random random(138);
  for (int run = 0; run < 30; ++run) {
    const ArmDescription description = skewed_slides(random);
    Parameters p;
    p.damping = 0;
    p.tick = random.one_of({1e-3, 4e-3});
    AnyArm arm(description);
    Arm<kAnyDof>::Frames frames;
    Mat<kAnyDof> M;
    Vector Cv;
    Arm<kAnyDof> model(description);
    model.frames(Vector::Zero(3), frames);
    model.inertia_bias(frames, Vector::Zero(3), M, Cv);
    const auto kinetic = [&] { return 0.5 * arm.v().dot(M * arm.v()); };
    arm.place(Vector::Zero(3), random.vector(3, 0.5), Vec3::Zero());
    for (int k = 0; k < 400; ++k) {
      const Vector torque = random.vector(3, k / 20 % 4 == 3 ? 0 : 1), from = arm.x();
      const double before = kinetic();
      arm.live(p, torque, kNoHand);
      ASSERT_LE(kinetic() - before, torque.dot(arm.x() - from) + 1e-13) << run << " " << k;
    }
    for (int k = 0; k < 200; ++k) arm.live(p, Vector::Zero(3), kNoHand);
    EXPECT_EQ(arm.v().norm(), 0);
  }
}

// The friction of each joint is a fifth more than what its weight asks for.
TEST(VirtualArm, HangsStillWhereFrictionBearsItsWeight) {
  ArmDescription description = random_arm(3, 139);
  description.gravity = {0, 0, -9.81};
  Vector x(3);
  x << 0.3, -0.4, 0.8;
  Arm<kAnyDof> model(description);
  Arm<kAnyDof>::Frames frames;
  model.frames(x, frames);
  const Vector weight = model.weight(frames, description.gravity);
  for (std::size_t i = 0; i < 3; ++i) {
    description.joints[i].friction = 1.2 * std::abs(weight[static_cast<int>(i)]) + 1e-6;
  }
  AnyArm arm(description);
  Parameters p;
  p.weighs = true;
  arm.place(x, Vector::Zero(3), Vec3::Zero());
  for (int k = 0; k < 2000; ++k) arm.live(p, Vector::Zero(3), kNoHand);
  EXPECT_EQ(arm.x(), x);
  EXPECT_EQ(arm.v().norm(), 0);
}

TEST(VirtualArm, IsHeldByItsStops) {
  ArmDescription description = wheel(3e-4);
  description.joints[0].lower = -0.5;
  description.joints[0].upper = 0.8;
  AnyArm arm(description);
  const Parameters p;
  for (const double torque : {1.0, -1.0}) {  // the motor's limit
    arm.place(one(0), one(0), Vec3::Zero());
    for (int k = 0; k < 3000; ++k) arm.live(p, one(torque), kNoHand);
    const double stop = torque > 0 ? 0.8 : -0.5;
    EXPECT_NEAR(arm.x()[0], stop + 0.01 * torque, 1e-4);
    EXPECT_NEAR(arm.v()[0], 0, 1e-6);
  }
}

TEST(VirtualDevice, IsReadInWholeEncoderSteps) {
  Random random(133);
  VirtualDevice<kAnyDof> device(random_arm(3, 133));
  const Vector x = random.vector(3, 1), v = random.vector(3, 1);
  device.arm.place(x, v, Vec3::Zero());
  Parameters p;
  const auto read = [&] {
    device.expect(p, kNoHand);
    DeviceReading reading;
    device.read(reading);
    return Vector(Eigen::Map<const Vector>(reading.x.data(), 3));
  };
  EXPECT_EQ(read(), x);
  p.encoder_step = 4e-4;
  const Vector shown = read();
  for (int i = 0; i < 3; ++i) {
    const double steps = shown[i] / p.encoder_step;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    EXPECT_LE(std::abs(shown[i] - x[i]), p.encoder_step / 2 * (1 + 1e-9));
  }
}

TEST(VirtualArm, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const ArmDescription description = random_arm(3, 134);
  Random random(135);
  const Eigen::VectorXd x = random.vector(3, 1), v = random.vector(3, 2);
  VirtualArm<3> fixed(description);
  AnyArm any(description);
  fixed.place(x, v, Vec3(0.1, 0, 0));
  any.place(x, v, Vec3(0.1, 0, 0));
  const Parameters p;
  for (int k = 0; k < 100; ++k) {
    const Eigen::VectorXd torque = random.vector(3, 0.1);
    fixed.live(p, torque, {Vec3(0.1, 0, 0), 0.5});
    any.live(p, torque, {Vec3(0.1, 0, 0), 0.5});
    ASSERT_LT((fixed.x() - any.x()).norm(), 1e-9);
  }
}

// Two independent joints: crossed axes through one point, a ball at the end. Inertias 5e-4 and 3e-4
// kg m^2.
ArmDescription two_wheels() {
  ArmDescription arm;
  arm.joints.resize(2);
  arm.links.resize(2);
  arm.joints[1].axis = Vec3::UnitX();
  arm.links[0].inertia = 2e-4 * Mat3::Identity();
  arm.links[1].inertia = 3e-4 * Mat3::Identity();
  arm.joints[0].effort = 1;
  arm.joints[1].effort = 0.25;
  return arm;
}

Vector two(double a, double b) { return Eigen::Vector2d(a, b); }

TEST(VirtualArm, RubsInEachJointByItsOwnFriction) {
  ArmDescription description = two_wheels();
  description.joints[0].friction = 0.02;
  description.joints[1].friction = 0.05;
  AnyArm arm(description);
  Parameters p;
  p.damping = 0;
  arm.place(two(0, 0), two(6, -20), Vec3::Zero());
  for (int k = 1; k <= 100; ++k) {
    arm.live(p, two(0, 0), kNoHand);
    const double t = k * p.tick;
    ASSERT_NEAR(arm.v()[0], 6 - 0.02 / 5e-4 * t, 0.01) << k;
    ASSERT_NEAR(arm.v()[1], -20 + 0.05 / 3e-4 * t, 0.01) << k;
  }
}

TEST(VirtualArm, IsDampedInEachJointByItsOwnDamper) {
  ArmDescription description = two_wheels();
  description.joints[0].damping = 0.004;
  description.joints[1].damping = 0.009;
  AnyArm arm(description);
  arm.place(two(0, 0), two(2, -3), Vec3::Zero());
  for (int k = 0; k < 50; ++k) arm.live(Parameters{}, two(0, 0), kNoHand);
  EXPECT_NEAR(arm.v()[0], 2 * std::exp(-0.004 / 5e-4 * 0.05), 1e-4);
  EXPECT_NEAR(arm.v()[1], -3 * std::exp(-0.009 / 3e-4 * 0.05), 1e-4);
}

TEST(VirtualArm, IsHeldByTheStopsOfEachJointAsItsMotorIsStrong) {
  ArmDescription description = two_wheels();
  description.joints[0].lower = -0.5;
  description.joints[0].upper = 0.8;
  description.joints[1].lower = -0.3;
  description.joints[1].upper = 0.4;
  for (const double sign : {1.0, -1.0}) {
    AnyArm arm(description);
    arm.place(two(0, 0), two(0, 0), Vec3::Zero());
    Parameters p;
    p.damping = 0.012;
    for (int k = 0; k < 3000; ++k) arm.live(p, sign * two(0.6, 0.2), kNoHand);
    // 0.01 rad at the motor's limit.
    EXPECT_NEAR(arm.x()[0], (sign > 0 ? 0.8 : -0.5) + sign * 0.01 * 0.6 / 1, 1e-5);
    EXPECT_NEAR(arm.x()[1], (sign > 0 ? 0.4 : -0.3) + sign * 0.01 * 0.2 / 0.25, 1e-5);
  }
}

TEST(VirtualArm, BouncesOffItsStopsAsAHalfDampedSpringDoes) {
  // Damping ratio 1/2: after half a swing exp(-pi/sqrt(3)) = 0.163 of the speed is left.
  ArmDescription description = two_wheels();
  description.joints[0].upper = 0.1;
  description.joints[1].lower = -0.1;
  AnyArm arm(description);
  Parameters p;
  p.damping = 0;
  p.substeps = 100;
  arm.place(two(0, 0), two(4, -3), Vec3::Zero());
  for (int k = 0; k < 150; ++k) arm.live(p, two(0, 0), kNoHand);
  const double left = std::exp(-3.14159265358979 / std::sqrt(3.0));
  EXPECT_NEAR(arm.v()[0], -4 * left, 0.05 * 4 * left);
  EXPECT_NEAR(arm.v()[1], 3 * left, 0.05 * 3 * left);
}

TEST(VirtualArm, IsPulledByAHandThatGoesEvenlyFromTargetToTarget) {
  // An arm too heavy to move; its tip at (1, 0, 0) is pulled sideways.
  constexpr double k_h = 300, b_h = 2, d = 0.004;
  Parameters p;
  p.hand_stiffness = k_h;
  p.hand_damping = b_h;
  for (const double grip : {1.0, 0.3}) {
    AnyArm arm(wheel(1e9));
    arm.place(one(0), one(0), Vec3::UnitX());
    arm.live(p, one(0), {Vec3(1, d, 0), grip});
    EXPECT_NEAR(arm.hand_torque()[0], grip * (k_h * d / 2 + b_h * d / p.tick), 1e-9);
    arm.live(p, one(0), {Vec3(1, 3 * d, 0), grip});
    EXPECT_NEAR(arm.hand_torque()[0], grip * (k_h * 2 * d + b_h * 2 * d / p.tick), 1e-9);
    arm.live(p, one(0), {Vec3(1, 3 * d, 0), grip});
    EXPECT_NEAR(arm.hand_torque()[0], grip * k_h * 3 * d, 1e-9);
    const double push = 0.25;
    arm.live(p, one(0), {Vec3(1, 3 * d, 0), grip, std::span(&push, 1)});
    EXPECT_NEAR(arm.hand_torque()[0], grip * k_h * 3 * d + 0.25, 1e-9);
  }
}

TEST(VirtualArm, IsMovedByATorqueOfTheHandAsByOneOfTheMotors) {
  Random random(136);
  const ArmDescription description = random_arm(4, 136);
  const Vector x = random.vector(4, 1), v = random.vector(4, 2);
  AnyArm pushed(description), driven(description);
  pushed.place(x, v, Vec3::Zero());
  driven.place(x, v, Vec3::Zero());
  for (int k = 0; k < 50; ++k) {
    const Vector torque = random.vector(4, 0.05), half = 0.5 * torque;
    const std::span hand(half.data(), 4);
    pushed.live(Parameters{}, half, {Vec3::Zero(), 0, hand});
    driven.live(Parameters{}, torque, kNoHand);
    ASSERT_LT((pushed.x() - driven.x()).norm(), 1e-12);
    ASSERT_LT((pushed.hand_torque() - half).norm(), 1e-15);
    ASSERT_EQ(driven.hand_torque().norm(), 0);
  }
}

TEST(VirtualDevice, IsReadAtTheNearestEncoderStep) {
  VirtualDevice<kAnyDof> device(two_wheels());
  device.arm.place(two(3.6e-3, -3.6e-3), two(0, 0), Vec3::Zero());
  Parameters p;
  p.encoder_step = 1e-3;
  device.expect(p, kNoHand);
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_NEAR(reading.x[0], 4e-3, 1e-15);
  EXPECT_NEAR(reading.x[1], -4e-3, 1e-15);
}

TEST(VirtualDevice, IsPlacedWithItsMotorsWhereTransmissionsAreElastic) {
  VirtualDevice<kAnyDof> device(two_wheels());
  Parameters p;
  p.damping = 0;
  p.resonance = 100;
  device.expect(p, kNoHand);
  const double x[] = {0.3, -0.2}, v[] = {0.5, -1};
  device.place(x, v, Vec3::Zero());
  DeviceReading reading;
  ASSERT_TRUE(device.read(reading));
  EXPECT_EQ(reading.x[0], 0.3);
  EXPECT_EQ(reading.x[1], -0.2);
  const double none[] = {0, 0};
  for (int k = 0; k < 100; ++k) device.write(none);
  ASSERT_TRUE(device.read(reading));
  EXPECT_NEAR(reading.x[0], 0.3 + 0.1 * 0.5, 1e-9) << "motor and link go on together";
  EXPECT_NEAR(reading.x[1], -0.2 - 0.1 * 1, 1e-9);
}

TEST(VirtualDevice, IsReadAnewEachTimeAndLivesThroughATickAWrite) {
  VirtualDevice<kAnyDof> device(two_wheels());
  EXPECT_EQ(device.traits().dof, 2);
  EXPECT_EQ(device.traits().effort, (std::vector<double>{1, 0.25}));
  EXPECT_FALSE(device.traits().guarded) << "no hand is on it that could be hurt";
  Parameters p;
  p.damping = 0;
  p.tick = 0.002;
  p.encoder_step = 1e-3;
  device.expect(p, kNoHand);
  device.arm.place(two(0.0123, 0), two(0, 0), Vec3::Zero());
  DeviceReading reading;
  for (std::uint64_t k = 1; k <= 3; ++k) {
    ASSERT_TRUE(device.read(reading));
    EXPECT_EQ(reading.count, k);
    EXPECT_EQ(reading.age, 0);
  }
  EXPECT_NEAR(reading.x[0], 0.012, 1e-15);
  const double torque[] = {0.1, -0.06};
  device.write(torque);
  EXPECT_NEAR(device.arm.v()[0], 0.1 / 5e-4 * 0.002, 1e-12);
  EXPECT_NEAR(device.arm.v()[1], -0.06 / 3e-4 * 0.002, 1e-12);
  device.stop();  // without torque it moves on unchanged
  EXPECT_NEAR(device.arm.v()[0], 0.4, 1e-12);
}

}  // namespace
}  // namespace limpid
