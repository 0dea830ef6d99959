// Torques from parameters against the arm's own M and C, and against the slope of its links'
// potential energy.
#include "core/dynamics/regressor.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;
using test::Slides;
using Any = Arm<kAnyDof>;
using Vector = Vec<kAnyDof>;

// Potential energy of the links, -sum m g.c.
double height_energy(const ArmDescription& description, const Vector& x, const Vec3& gravity) {
  const Any arm(description);
  Any::Frames f;
  arm.frames(x, f);
  double energy = 0;
  for (int i = 0; i < description.dof(); ++i) {
    const Link& link = description.links[static_cast<std::size_t>(i)];
    energy -= link.mass * gravity.dot(Any::point(f, i, link.com));
  }
  return energy;
}

class RegressorOf : public testing::TestWithParam<std::tuple<int, Slides>> {};
INSTANTIATE_TEST_SUITE_P(Arms, RegressorOf,
                         testing::Combine(testing::Values(1, 3, 7),
                                          testing::Values(Slides::none, Slides::some,
                                                          Slides::all)));

TEST_P(RegressorOf, GivesTheTorquesOfTheArm) {
  const int n = std::get<0>(GetParam());
  const ArmDescription description = random_arm(n, 301, std::get<1>(GetParam()));
  const Any arm(description);
  Random random(302);
  const Vec3 gravity = 9.81 * random.direction();
  for (int round = 0; round < 20; ++round) {
    const Vector x = random.vector(n, 2), v = random.vector(n, 4), a = random.vector(n, 30);
    Any::Frames f;
    Mat<kAnyDof> M, C;
    arm.frames(x, f);
    arm.inertia_coriolis(f, v, M, C);
    Eigen::VectorXd weight(n);
    for (int i = 0; i < n; ++i) {
      constexpr double h = 1e-3;
      const auto at = [&](double s) {
        Vector moved = x;
        moved[i] += s * h;
        return height_energy(description, moved, gravity);
      };
      weight[i] = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h);
    }
    const Eigen::VectorXd torque = regressor(arm, x, v, a, gravity) * parameters_of(description);
    const Eigen::VectorXd wanted = M * a + C * v + weight;
    EXPECT_LT((torque - wanted).norm(), 1e-10 * wanted.norm());
    EXPECT_LT((arm.weight(f, gravity) - weight).norm(), 1e-9 * weight.norm());
  }
}

TEST(LinkParameters, MakeTheLinkThatTheyAreOf) {
  const ArmDescription arm = random_arm(2, 303);
  Link again;
  set_parameters(again, parameters_of(arm.links[1]));
  EXPECT_NEAR(again.mass, arm.links[1].mass, 1e-16);
  EXPECT_LT((again.com - arm.links[1].com).norm(), 1e-16);
  EXPECT_LT((again.inertia - arm.links[1].inertia).norm(), 1e-18);
}

}  // namespace
}  // namespace limpid
