// A point's acceleration at constant joint rates against the difference of its velocities.
#include <gtest/gtest.h>

#include "core/dynamics/arm.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

template <int N>
void expect_the_slope_of_the_velocity(int n, unsigned seed) {
  const ArmDescription description = test::random_arm(n, seed);
  const Arm<N> arm(description);
  test::Random random(seed + 1);
  for (int round = 0; round < 10; ++round) {
    const Vec<N> x = random.vector(n, 3), v = random.vector(n, 4);
    const Vec3 in_link = random.point(0.1);
    for (int link = 0; link < n; ++link) {
      // Along the straight line x + t v the joint rates are constant.
      const auto velocity = [&](double t) {
        typename Arm<N>::Frames f;
        arm.frames(Vec<N>(x + t * v), f);
        Jacobian<N> J;
        arm.point_jacobian(f, link, Arm<N>::point(f, link, in_link), J);
        return Vec3(J * v);
      };
      constexpr double h = 1e-4;
      const Vec3 slope =
          (8 * (velocity(h) - velocity(-h)) - (velocity(2 * h) - velocity(-2 * h))) / (12 * h);
      typename Arm<N>::Frames f;
      arm.frames(x, f);
      const Vec3 drift = arm.point_drift(f, link, Arm<N>::point(f, link, in_link), v);
      ASSERT_LT((drift - slope).norm(), 1e-9 * v.squaredNorm()) << n << " joints, link " << link;
    }
  }
}

TEST(PointDrift, IsTheAccelerationAtConstantJointRates) {
  for (int n = 1; n <= 7; ++n) {
    expect_the_slope_of_the_velocity<kAnyDof>(n, 71 + static_cast<unsigned>(n));
  }
  expect_the_slope_of_the_velocity<3>(3, 79);
}

}  // namespace
}  // namespace limpid
