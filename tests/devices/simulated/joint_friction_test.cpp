// Friction of several joints at once, against what Coulomb's law says of each.
#include "devices/simulated/joint_friction.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Vector = Vec<kAnyDof>;

struct Drawn {
  Mat<kAnyDof> A;
  Vector b, v, f;
};

Drawn drawn(Random& random, double speed) {
  const int n = static_cast<int>(random.between(1, 12.99));
  const Vector f = random.vector(n, 1).cwiseMax(0);  // some joints have none
  return {random.positive_definite(n, 1e-3, 10), random.vector(n, 2), random.vector(n, speed), f};
}

TEST(JointFriction, HoldsAJointOrPullsAgainstItsMotion) {
  Random random(140);
  for (int run = 0; run < 2000; ++run) {
    const Drawn d = drawn(random, 0);
    const Vector dv = JointFriction<kAnyDof>(d.A, d.b, d.v, d.f).change();
    const Vector l = d.A * dv - d.b;
    for (int i = 0; i < l.size(); ++i) {
      EXPECT_LE(std::abs(l[i]), d.f[i] * (1 + 1e-8) + 1e-10) << run;
      EXPECT_NEAR(l[i] * dv[i], -d.f[i] * std::abs(dv[i]), 1e-8) << run;
    }
  }
}

TEST(JointFriction, OnlyTakesEnergy) {
  Random random(141);
  for (int run = 0; run < 2000; ++run) {
    const Drawn d = drawn(random, random.log_between(0.01, 100));
    const Vector dv = JointFriction<kAnyDof>(d.A, d.b, d.v, d.f).change();
    const Vector l = d.A * dv - d.b, mean = d.v + 0.5 * dv;
    EXPECT_LE(l.dot(mean), 1e-8) << run;
  }
}

}  // namespace
}  // namespace limpid
