// The torque for the device's own weight, springs and friction.
#include "core/tick/compensation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;

constexpr double kTick = 0.001;

Parameters with(const CompensationSettings& compensation, Down down = Down::as_file) {
  Parameters p;
  static_cast<CompensationSettings&>(p) = compensation;
  p.down = down;
  return p;
}

struct Bench {
  explicit Bench(int n, unsigned seed = 601)
      : description(test::random_arm(n, seed)), arm(description) {
    Random random(seed + 1);
    for (Joint& joint : description.joints) {
      joint.spring = random.between(0.05, 0.3);
      joint.offset = random.between(-0.05, 0.05);
    }
    description.gravity = 9.81 * random.direction();
    x = random.vector(n, 1.5);
    zero = Vector::Zero(n);
    friction = Vector::Constant(n, 0.02);
    arm.frames(x, frames);
  }
  Vector at(Compensation<kAnyDof>& c, const Parameters& p, const Vector& v, double step = 0) const {
    return c.step(p, arm, frames, x, v, friction, step, kTick);
  }

  ArmDescription description;
  Arm<kAnyDof> arm;
  Arm<kAnyDof>::Frames frames;
  Vector x, zero, friction;
};

TEST(Compensation, IsNothingUntilItIsAskedFor) {
  const Bench bench(3);
  Compensation<kAnyDof> c(bench.description);
  c.start({});
  EXPECT_EQ(bench.at(c, {}, Vector::Constant(3, 2)), bench.zero);
  EXPECT_TRUE(c.steady());
}

TEST(Compensation, HoldsWeightAndSpringsWhereTheArmIs) {
  const Bench bench(4);
  const Parameters both = with({.holds_weight = true, .holds_springs = true});
  Compensation<kAnyDof> c(bench.description);
  c.start(both);
  Vector wanted = bench.arm.weight(bench.frames, bench.description.gravity);
  for (int i = 0; i < 4; ++i) {
    const Joint& joint = bench.description.joints[static_cast<std::size_t>(i)];
    wanted[i] += joint.spring * bench.x[i] + joint.offset;
  }
  EXPECT_LT((bench.at(c, both, bench.zero) - wanted).norm(), 1e-14);
}

TEST(Compensation, GoesByWhereDownIsSaidToBe) {
  const Bench bench(3);
  const Vec3 downs[] = {{0, 0, -1}, {0, 0, 1}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
  for (int i = 0; i < 6; ++i) {
    const Parameters p = with({.holds_weight = true}, static_cast<Down>(i + 1));
    Compensation<kAnyDof> c(bench.description);
    c.start(p);
    const Vector wanted = bench.arm.weight(bench.frames, 9.81 * downs[i]);
    EXPECT_LT((bench.at(c, p, bench.zero) - wanted).norm(), 1e-14)
        << kDowns[static_cast<std::size_t>(i + 1)];
  }
}

// Holds for any error of the velocity: noise, delay, the wrong sign.
TEST(Compensation, NeverPutsOutMoreThanItsShareOfTheFriction) {
  const Bench bench(2);
  Random random(603);
  const Parameters p = with({.friction_share = 0.7});
  Compensation<kAnyDof> c(bench.description);
  c.start(p);
  double put_out = 0, taken = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vector v = random.vector(2, k % 3 == 0 ? 20 : 0.2), dx = random.vector(2, 1e-3);
    const Vector torque = bench.at(c, p, v);
    ASSERT_LE(torque.cwiseAbs().maxCoeff(), 0.7 * 0.02 * (1 + 1e-12));
    put_out += std::abs(torque.dot(dx));
    taken += 0.02 * dx.cwiseAbs().sum();
  }
  EXPECT_LE(put_out, 0.7 * taken);
}

TEST(Compensation, TakesItsShareOffWhenTheDeviceMovesOn) {
  const Bench bench(2);
  const Parameters p = with({.friction_share = 0.7});
  Compensation<kAnyDof> c(bench.description);
  c.start(p);
  Vector torque;
  for (int k = 0; k < 300; ++k) torque = bench.at(c, p, Vector::Constant(2, -1), 1e-4);
  EXPECT_NEAR(torque[0], -0.7 * 0.02, 0.05 * 0.7 * 0.02);
}

// An encoder of 10 bits at the edge of a cell: at every tick it may step there or back, at random.
TEST(Compensation, DoesNotChatterWhereAnEncoderFlickers) {
  const Bench bench(1);
  const Parameters p = with({.friction_share = 0.7});
  Compensation<kAnyDof> c(bench.description);
  c.start(p);
  Random random(604);
  const double step = 7e-4;
  double before = 0, sum = 0;
  constexpr int kTicks = 20000;
  for (int k = 0; k < kTicks; ++k) {
    const double now = random.between(0, 1) < 0.5 ? 0 : step;
    const double torque = bench.at(c, p, Vector::Constant(1, (now - before) / kTick), step)[0];
    before = now;
    sum += torque * torque;
  }
  EXPECT_LT(std::sqrt(sum / kTicks), 0.2 * 0.7 * 0.02);
}

TEST(Compensation, GoesOverToAnotherSettingWithinHalfASecondAndNoFaster) {
  const Bench bench(3);
  const Parameters all = with({.holds_weight = true, .friction_share = 0.7, .holds_springs = true});
  Compensation<kAnyDof> c(bench.description), there(bench.description);
  c.start({});
  there.start(all);
  const Vector moving = Vector::Constant(3, 5);
  Vector full;
  for (int k = 0; k < 300; ++k) full = bench.at(there, all, moving);
  for (int k = 0; k < 300; ++k) bench.at(c, {}, moving);
  Vector before = bench.zero;
  for (int k = 0; k < 499; ++k) {
    const Vector now = bench.at(c, all, moving);
    ASSERT_FALSE(c.steady()) << k;
    const double most =
        (bench.arm.weight(bench.frames, bench.description.gravity).norm() + 1) * kTick / 0.5;
    ASSERT_LT((now - before).norm(), 1.1 * most) << k;
    before = now;
  }
  for (int k = 0; k < 3; ++k) before = bench.at(c, all, moving);
  EXPECT_TRUE(c.steady());
  EXPECT_LT((before - full).norm(), 1e-9);
}

TEST(Compensation, IsNotSteadyWhileAnyOfItIsOnItsWay) {
  const Bench bench(3);
  for (const Parameters& one : {with({.holds_weight = true}), with({.friction_share = 0.95}),
                                with({.holds_springs = true})}) {
    Compensation<kAnyDof> c(bench.description);
    c.start({});
    const int ticks = one.friction_share > 0 ? 475 : 500;
    for (int k = 1; k < ticks; ++k) {
      bench.at(c, one, bench.zero);
      ASSERT_FALSE(c.steady()) << k;
    }
    for (int k = 0; k < 3; ++k) bench.at(c, one, bench.zero);
    EXPECT_TRUE(c.steady());
    bench.at(c, {}, bench.zero);
    EXPECT_FALSE(c.steady());
  }
}

}  // namespace
}  // namespace limpid
