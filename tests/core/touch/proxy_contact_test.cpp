// The proxy in contact: forces at the midpoint, energy stored and given back, never a pull.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "core/touch/proxy.h"
#include "tests/support/proxy_drive.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::no_drive;
using test::Random;
using test::random_arm;
using AnyProxy = Proxy<kAnyDof>;
using Vector = Vec<kAnyDof>;

TEST(ProxyInContact, OfOneJointFollowsTheScalarMidpointRule) {
  constexpr double T = 0.001, K = 20, k_vc = 10, b = 0.013, kAngle = 0.2;
  Scene scene;
  scene.add({.shape = JointStop{0, kAngle, 1}, .material = {K}});
  AnyProxy proxy(random_arm(1, 50), scene);
  proxy.place(Vector::Constant(1, 0), Vector::Constant(1, 0), 1e-4);
  const double m = proxy.M()(0, 0);
  double x = 0, v = 0;
  int touching = 0;
  for (int k = 0; k < 600; ++k) {
    const double pull = 0.6 * std::sin(0.01 * k);  // into the stop and out of it again
    ProxyDrive<kAnyDof> drive = no_drive(1);
    drive.constant << k_vc * (pull - proxy.x()[0]);
    drive.damping.setConstant(b + k_vc * T / 2);
    proxy.advance(T, drive);

    const double stiff = 2 * m / T + b + k_vc * T / 2;
    const double force = 2 * m * v / T + k_vc * (pull - x);
    double vbar = force / stiff;
    double f2 = 0;
    if (x - kAngle + T / 2 * vbar > 0) {
      vbar = (force - K * (x - kAngle)) / (stiff + K * T / 2);
      f2 = -K * (x - kAngle + T / 2 * vbar);
    }
    x += T * vbar;
    v = 2 * vbar - v;
    touching += f2 != 0 ? 1 : 0;
    ASSERT_NEAR(proxy.f()[0], f2, 1e-10) << k;
    ASSERT_NEAR(proxy.x()[0], x, 1e-12) << k;
    ASSERT_NEAR(proxy.v()[0], v, 1e-8) << k;
  }
  EXPECT_GT(touching, 100);
}

TEST(ProxyInContact, ThatLastsKeepsItsEnergy) {
  // Stops of 20 N m/rad are pressed by half a radian with 10 N m; the joints swing by 0.15 rad. No
  // joint leaves, and in joint space a stop is linear: the energy lost by the motion is stored to
  // round-off.
  for (const int n : {1, 3, 7}) {
    for (const double T : {0.001, 0.008}) {
      Random random(51);
      const Vector x = random.vector(n, 2);
      Scene scene;
      for (int j = 0; j < n; ++j)
        scene.add({.shape = JointStop{j, x[j] - 0.65, 1}, .material = {20}});
      AnyProxy proxy(random_arm(n, 52), scene);
      proxy.place(x, Vector::Zero(n), 0.5);
      ProxyDrive<kAnyDof> drive = no_drive(n);
      drive.constant.setConstant(10);
      double swung = 0;
      for (int k = 0; k < 2000; ++k) {
        proxy.advance(T, drive);
        // Energy about the balance, equal to that at release.
        const Vector off = proxy.x() - x + Vector::Constant(n, 0.15);
        const double energy = proxy.kinetic_energy() + 0.5 * 20 * off.squaredNorm();
        ASSERT_NEAR(energy, 0.5 * 20 * 0.15 * 0.15 * n, 1e-11) << "step " << k;
        swung = std::max(swung, (proxy.x() - x).norm());
      }
      EXPECT_GT(swung, 0.1);
    }
  }
}

// Five balls around the tip, a plane and a stop: touched and left at every moment.
Scene crowd(const ArmDescription& description, const Vector& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  arm.frames(x, f);
  const Vec3 tip = arm.tip(f);
  Random random(53);
  Scene scene;
  scene.tip_radius = 0.004;
  for (int i = 0; i < 5; ++i) {
    scene.add(
        {"", pose_at(tip + 0.03 * random.direction()), Sphere{0.02}, random.between(100, 2000)});
  }
  scene.add({"", pose_at(tip - Vec3(0, 0, 0.01)), Plane{Vec3::UnitZ()}, 600});
  Object box{.pose = pose_at(tip + Vec3(0.05, 0, 0)), .shape = Box{}};
  box.pose.linear() = random.rotation();
  scene.add(box);
  scene.add({.shape = JointStop{0, x[0] + 0.05, 1}, .material = {20}});
  scene.probes.push_back(
      {"", description.dof() - 1, Vec3::Zero(), 0.9 * description.tip.translation(), 0.01});
  return scene;
}

class ProxyAmongThings : public testing::TestWithParam<std::tuple<int, double, double>> {};
INSTANTIATE_TEST_SUITE_P(ArmsTicksAndRatios, ProxyAmongThings,
                         testing::Combine(testing::Values(2, 3, 7), testing::Values(0.001, 0.008),
                                          testing::Values(1e-4, 1.0)));

TEST_P(ProxyAmongThings, BalancesEnergyNeverIsPulledAndStaysFinite) {
  const auto [n, T, ratio] = GetParam();
  const ArmDescription description = random_arm(n, 54);
  Random random(55);
  const Vector x0 = random.vector(n, 1);
  AnyProxy proxy(description, crowd(description, x0));
  proxy.place(x0, Vector::Zero(n), ratio);
  Vector goal = x0;
  int touched = 0, several = 0;
  for (int k = 0; k < 3000; ++k) {
    if (k % 50 == 0) goal = x0 + random.vector(n, 0.3);
    ProxyDrive<kAnyDof> drive = no_drive(n);
    drive.constant = 10 * (goal - proxy.x());
    drive.damping = 0.013 + (10 * T / 2 * (1 + random.vector(n, 0.9).array()));
    // The proposed coupling returns f2 with the factor phi^T/eta - I, here with a small phi.
    drive.share = {ratio < 1 ? 0.001 : 0.5};
    const double before = proxy.kinetic_energy();
    const Vector x = proxy.x();
    proxy.advance(T, drive);
    const Vector dx = proxy.x() - x;
    const double after = proxy.kinetic_energy();
    const double torques = proxy.tau().norm() + proxy.f().norm();
    ASSERT_NEAR(after - before, (proxy.tau() + proxy.f()).dot(dx),
                1e-11 * std::max(before, after) + 1e-15 * torques * (x.norm() + 1));
    // The torque is the contact forces' sum, and no force pulls.
    Vector f2 = Vector::Zero(n);
    int pushing = 0;
    for (const auto& contact : proxy.contacts().list()) {
      ASSERT_GE(contact.force, 0);
      f2 -= contact.force * contact.gradient;
      pushing += contact.force > 0 ? 1 : 0;
      // The force follows from the depth at the midpoint.
      const double middle = contact.depth + contact.gradient.dot(dx) / 2;
      ASSERT_NEAR(contact.force, contact.force > 0 ? contact.material.stiffness * middle : 0, 1e-8);
    }
    for (const auto& corner : proxy.contacts().corners()) {
      if (corner.rank == 0) continue;
      f2 += corner.J.transpose() * corner.force;
      pushing += corner.force.isZero(0) ? 0 : 1;
      const Vec3 middle = corner.J * dx / 2;
      Vec3 pull = Vec3::Zero();
      for (int i = 0; i < corner.rank; ++i) {
        const Vec3 e = corner.direction.col(i);
        pull += (corner.depth[i] - e.dot(middle)) * e;
      }
      ASSERT_LT((corner.force - corner.material.stiffness * pull).norm(), 1e-8);
    }
    ASSERT_LT((f2 - proxy.f()).norm(), 1e-12 * (1 + f2.norm()));
    // Torque of the drive, share of the contacts included.
    const Vector tau = drive.constant - drive.damping.cwiseProduct(proxy.vbar()) +
                       (drive.share.direct - 1) * proxy.f();
    ASSERT_LT((tau - proxy.tau()).norm(), 1e-9 * (1 + torques));
    ASSERT_TRUE(proxy.x().allFinite());
    touched += pushing > 0 ? 1 : 0;
    several += pushing > 1 ? 1 : 0;
  }
  EXPECT_GT(touched, 300);
  EXPECT_GT(several, 30);
}

TEST(ProxyInContact, RestsWhereSpringAndSurfaceBalance) {
  // A stop of 20 N m/rad against a spring of 10: the proxy rests two thirds of the way back.
  constexpr int n = 3;
  Random random(56);
  const Vector x = random.vector(n, 1);
  Scene scene;
  scene.add({.shape = JointStop{1, x[1] - 0.3, 1}, .material = {20}});
  AnyProxy proxy(random_arm(n, 57), scene);
  proxy.place(x, Vector::Zero(n), 1e-4);
  for (int k = 0; k < 4000; ++k) {
    ProxyDrive<kAnyDof> drive = no_drive(n);
    drive.constant = 10 * (x - proxy.x());
    drive.damping.setConstant(0.013 + 10 * 0.001 / 2);
    proxy.advance(0.001, drive);
  }
  EXPECT_NEAR(proxy.x()[1], x[1] - 0.3 * 20 / 30, 1e-6);
  EXPECT_NEAR(proxy.f()[1], -20 * 0.1, 1e-5);
  EXPECT_NEAR(proxy.tau()[1], 20 * 0.1, 1e-5);
  EXPECT_NEAR(proxy.contact_potential(), 0.5 * 20 * 0.1 * 0.1, 1e-6);
}

}  // namespace
}  // namespace limpid
