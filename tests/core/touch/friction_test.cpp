// Friction against its law, written out independently, and against its balance of energy.
#include <gtest/gtest.h>

#include <array>

#include "core/touch/wall_force.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

struct Rub {
  double K_t, radius, T;
  Vec2 z, b;
  Mat2 W;

  Vec2 force() const { return friction_force(K_t, radius, z, T, b, W); }
  Vec2 speed(const Vec2& l) const { return b + W * l; }
  // Friction by its law, for the motion under the force l.
  Vec2 wanted(const Vec2& l) const {
    const Vec2 free = -K_t * (z + T * speed(l));
    return free.norm() > radius ? Vec2(radius * free.normalized()) : free;
  }
  double given(const Vec2& l) const {  // work and change of the energy in the spring [J]
    return T * l.dot(speed(l)) + 0.5 * K_t * ((l / K_t).squaredNorm() - z.squaredNorm());
  }
};

// A random contact whose response W is positive definite, not quite symmetric, and of size
// `stiffness`/(K_t T).
Rub some_rub(Random& random, double stiffness) {
  Rub r{};
  r.K_t = random.between(50, 2000);
  r.T = random.between(2e-4, 2e-3);
  r.radius = std::pow(10, random.between(-3, 1));
  const double angle = random.between(0, 3.2), thin = random.between(0.05, 1);
  const Mat2 turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  Mat2 skew;
  skew << 0, 1, -1, 0;
  r.W = turn * Vec2(1, thin).asDiagonal() * turn.transpose();
  r.W += 0.05 * thin * random.between(-1, 1) * skew;
  r.W *= stiffness / (r.K_t * r.T);
  const double stretch = r.radius / r.K_t;
  r.z = stretch * random.between(0, 1.5) * Vec2::Unit(0);
  r.z = Eigen::Rotation2Dd(random.between(0, 6.3)) * r.z;
  const double fast = std::pow(10, random.between(-2, 2)) * stretch / r.T;
  r.b = fast * (Eigen::Rotation2Dd(random.between(0, 6.3)) * Vec2::UnitX());
  return r;
}

TEST(Friction, IsNeverMoreThanTheDiscAllows) {
  Random random(21);
  for (int round = 0; round < 100000; ++round) {
    const Rub r = some_rub(random, std::pow(10, random.between(-4, 2)));
    ASSERT_LE(r.force().norm(), r.radius * (1 + 1e-15));
  }
}

TEST(Friction, ThatSticksIsTheSpringSolvedWithTheMotion) {
  Random random(22);
  int stuck = 0;
  for (int round = 0; round < 100000; ++round) {
    const Rub r = some_rub(random, std::pow(10, random.between(-4, 2)));
    const Mat2 A = Mat2::Identity() + r.K_t * r.T * r.W;
    const Vec2 right = -r.K_t * (r.z + r.T * r.b);
    const Vec2 sticking = A.inverse() * right;
    const Vec2 l = r.force();
    if (sticking.norm() > r.radius * (1 - 1e-12)) {
      ASSERT_GT(l.norm(), 0);
      continue;
    }
    ++stuck;
    ASSERT_LT((l - sticking).norm(), 1e-13 * right.norm());
  }
  EXPECT_GT(stuck, 20000);
}

TEST(Friction, ThatSlipsIsAsLargeAsItMayAndOpposesTheStretchedSpring) {
  Random random(23);
  int slipped = 0;
  for (int round = 0; round < 100000; ++round) {
    // A contact of a device: the response of a tick to a force, K_t T W, is about 0.1.
    const Rub r = some_rub(random, std::pow(10, random.between(-3, -0.7)));
    const Vec2 l = r.force();
    const Vec2 stretched = r.z + r.T * r.speed(l);
    if (r.K_t * stretched.norm() < r.radius * (1 + 1e-6)) continue;
    ++slipped;
    ASSERT_NEAR(l.norm(), r.radius, 1e-12 * r.radius);
    ASSERT_LT((l - r.wanted(l)).norm(), 1e-4 * r.radius);
    ASSERT_LT(l.dot(stretched), 0);
  }
  EXPECT_GT(slipped, 20000);
}

TEST(Friction, OfAnIsotropicAnswerIsExactAtOnce) {
  // With an isotropic response the force is along its drive, however strong the response is.
  Random random(24);
  for (int round = 0; round < 100000; ++round) {
    Rub r = some_rub(random, 1);
    r.W = std::pow(10, random.between(-4, 2)) / (r.K_t * r.T) * Mat2::Identity();
    const Vec2 l = r.force();
    ASSERT_LT((l - r.wanted(l)).norm(), 1e-12 * (r.radius + r.K_t * r.T * r.b.norm()));
  }
}

TEST(Friction, NeverGivesEnergy) {
  Random random(25);
  double most = 0;
  for (int round = 0; round < 300000; ++round) {
    const Rub r = some_rub(random, std::pow(10, random.between(-4, -0.7)));
    const Vec2 l = r.force();
    most = std::max(most, r.given(l) / (r.radius * r.radius / r.K_t));
    ASSERT_LT(r.given(l), 1e-12) << r.radius << ' ' << r.b.transpose();
  }
  RecordProperty("most", std::to_string(most));
}

TEST(Friction, WithoutARadiusIsNone) {
  Random random(26);
  Rub r = some_rub(random, 0.1);
  for (const double radius : {0.0, -1.0, std::nan("")}) {
    r.radius = radius;
    EXPECT_EQ(r.force(), Vec2::Zero());
  }
}

}  // namespace
}  // namespace limpid
