// The motors' torque against both of its limits, the force at the tip by an independent solution.
#include <gtest/gtest.h>

#include "core/math/eigen.h"
#include "core/tick/motor_stage.h"
#include "tests/support/random_arm.h"
#include "tests/support/singular_values.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;

constexpr double kTip = 10;  // [N]

// The smallest force at the tip that gives as much of this torque as it can, by its singular
// values. Directions that would take a thousand times the force of another one are left out.
double force_of(const Vector& tau, const Jacobian<kAnyDof>& J) {
  const SymmetricEigen squares = symmetric_eigen(J * J.transpose());
  Vec3 force = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (squares.values[i] < 1e-6 * squares.values[2]) continue;
    const Vec3 along = squares.vectors.col(i);
    force += along.dot(J * tau) / squares.values[i] * along;
  }
  return force.norm();
}

struct SomeArm {
  SomeArm(int n, unsigned seed) : description(test::random_arm(n, seed)), arm(description) {
    limit = of_joints<kAnyDof>(description, &Joint::effort);
  }
  Jacobian<kAnyDof> at(const Vector& x) {
    arm.frames(x, frames);
    Jacobian<kAnyDof> J;
    arm.point_jacobian(frames, arm.dof() - 1, arm.tip(frames), J);
    return J;
  }
  ArmDescription description;
  Arm<kAnyDof> arm;
  Arm<kAnyDof>::Frames frames;
  Vector limit;
};

// tau = J^T F: the force is the torque where J is the identity.
TEST(TorqueLimits, KeepTheForceAtTheTip) {
  const Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Identity(3, 2);
  const Vector most = Vector::Constant(2, 1000);
  const TorqueLimits<kAnyDof> limits(most, J, kTip);
  const Vector direction = Vec3(0.6, -0.8, 0).head(2);
  EXPECT_EQ(limits.within(0.9 * kTip * direction), 0.9 * kTip * direction);
  EXPECT_NEAR((limits.within(7 * kTip * direction) - kTip * direction).norm(), 0, 1e-6 * kTip);
}

TEST(TorqueLimits, ScaleTheTorquesOfAnyArmByTheForceTheyMake) {
  Random random(7);
  const Vector most = Vector::Constant(3, 1e6);
  for (int i = 0; i < 200; ++i) {
    const Vec3 force = 100 * Vec3(random.vector(3, 1));
    Eigen::Matrix3d square;
    for (int c = 0; c < 3; ++c) square.col(c) = Vec3(random.vector(3, 1));
    if (std::abs(square.determinant()) < 1e-2) continue;
    const Jacobian<kAnyDof> J = square;
    const Vector tau = J.transpose() * force;
    const double part = std::min(1.0, kTip / force.norm());
    const Vector held = TorqueLimits<kAnyDof>(most, J, kTip).within(tau);
    EXPECT_LT((held - part * tau).norm(), 1e-3 * tau.norm());
  }
}

// Motors stronger than necessary: the limit that acts is the tip's, the joints', or both.
TEST(TorqueLimits, HoldJointsAndTipTogetherForAHundredThousandTorques) {
  Random random(8);
  int by_tip = 0, by_joint = 0, by_both = 0;
  for (int a = 0; a < 50; ++a) {
    SomeArm some(1 + a % 7, 800 + static_cast<unsigned>(a));
    some.limit *= random.between(1, 6);
    for (int pose = 0; pose < 20; ++pose) {
      const Jacobian<kAnyDof> J = some.at(random.vector(some.arm.dof(), 3));
      const Eigen::VectorXd levers = test::singular_values(J);
      const bool stretched = levers.minCoeff() < 0.01 * levers.maxCoeff();
      const TorqueLimits<kAnyDof> limits(some.limit, J, kTip);
      for (int i = 0; i < 100; ++i) {
        const Vector wanted =
            some.limit.cwiseProduct(random.vector(some.arm.dof(), random.between(0.2, 4)));
        const Vector held = limits.within(wanted);
        ASSERT_TRUE((held.cwiseAbs().array() <= some.limit.array()).all());
        const double force = force_of(held, J);
        ASSERT_LE(force, kTip * (1 + 2e-3)) << a << ", " << pose << ", " << i;
        const bool joint = (wanted.cwiseAbs().array() > some.limit.array()).any();
        const bool tip = force > kTip * (1 - 2e-3);
        by_tip += tip && !joint;
        by_joint += joint && !tip;
        by_both += joint && tip;
        if (joint || tip || stretched) continue;
        ASSERT_EQ(held, wanted);
      }
    }
  }
  EXPECT_GT(by_tip, 1000);
  EXPECT_GT(by_joint, 1000);
  EXPECT_GT(by_both, 1000);
}

// Commands jump while the arm moves, a coupling is switched, a limit is lowered.
TEST(TorqueLimits, HoldWhileTheTorqueIsOnItsWay) {
  Random random(9);
  int on_the_way = 0;
  for (int a = 0; a < 20; ++a) {
    SomeArm some(2 + a % 6, 850 + static_cast<unsigned>(a));
    const int n = some.arm.dof();
    const Vector strong = 4 * some.limit;
    MotorStage<kAnyDof> motors(n);
    Vector x = random.vector(n, 3), command = Vector::Zero(n), before = command;
    const Vector v = random.vector(n, 5);
    Vector limit = strong;
    for (int k = 0; k < 5000; ++k) {
      x += 1e-3 * v;
      if (k % 30 == 0) command = strong.cwiseProduct(random.vector(n, 3));
      if (k % 700 == 0) motors.begin_slew();
      if (k % 900 == 0) limit = random.between(0.1, 1) * strong;
      const Jacobian<kAnyDof> J = some.at(x);
      const double gain = random.between(0.5, 1);
      const Vector tau = motors.pass(command, {limit, J, kTip}, gain, 1e-3, 0.02);
      ASSERT_TRUE((tau.cwiseAbs().array() <= limit.array() * (1 + 1e-12)).all()) << k;
      ASSERT_LE(force_of(tau, J), kTip * (1 + 2e-3)) << a << ", " << k;
      const Vector grown = tau.cwiseAbs() - before.cwiseAbs();
      ASSERT_TRUE((grown.array() <= limit.array() / 20 + 1e-12).all()) << k;
      on_the_way += (tau - before).norm() > 1e-3 ? 1 : 0;
      before = tau;
    }
  }
  EXPECT_GT(on_the_way, 20000);
}

}  // namespace
}  // namespace limpid
