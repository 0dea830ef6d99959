#include <gtest/gtest.h>

#include "core/math/eigen.h"
#include "devices/identify/fit.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

LinkParameters some(Random& random, double size) { return random.vector(10, size); }

TEST(PlausibleLink, IsTheGuessWhereNothingIsKnown) {
  const ArmDescription arm = test::random_arm(3, 401);
  for (const Link& link : arm.links) {
    const LinkParameters guess = parameters_of(link);
    const LinkParameters again = PlausibleLink(guess).at(LinkParameters::Zero());
    EXPECT_LT((again - guess).cwiseAbs().maxCoeff(), 1e-15);
  }
}

// Principal moments that obey the triangle inequality, with a mass, make a body.
TEST(PlausibleLink, IsABodyWhateverTheNumbers) {
  Random random(402);
  const PlausibleLink link(parameters_of(test::random_arm(1, 403).links[0]));
  for (int round = 0; round < 500; ++round) {
    Link body;
    set_parameters(body, link.at(some(random, 3)));
    ASSERT_GT(body.mass, 0);
    const Vec3 moments = symmetric_eigen(body.inertia).values;
    ASSERT_GT(moments[0], -1e-12 * moments[2]);
    ASSERT_GE(moments[0] + moments[1], moments[2] * (1 - 1e-9));
  }
}

TEST(PlausibleLink, HasTheSlopeOfItself) {
  Random random(404);
  const PlausibleLink link(parameters_of(test::random_arm(1, 405).links[0]));
  constexpr double h = 1e-4;
  for (int round = 0; round < 20; ++round) {
    const LinkParameters d = some(random, 1);
    const auto slope = link.slope(d);
    for (Eigen::Index i = 0; i < kLinkParameters; ++i) {
      const LinkParameters step = h * LinkParameters::Unit(i);
      const LinkParameters wanted = (8 * (link.at(d + step) - link.at(d - step)) -
                                     (link.at(d + 2 * step) - link.at(d - 2 * step))) /
                                    (12 * h);
      ASSERT_LT((slope.col(i) - wanted).norm(), 1e-9 * slope.norm());
    }
  }
}

TEST(PlausibleLink, GivesAPointSomeExtent) {
  Link point;
  point.mass = 0.05;
  point.com = Vec3(0.1, 0, 0);
  Link body;
  set_parameters(body, PlausibleLink(parameters_of(point)).at(LinkParameters::Zero()));
  EXPECT_NEAR(body.mass, 0.05, 0.005);
  EXPECT_NEAR(body.com.x(), 0.1, 0.01);
  EXPECT_GT(symmetric_eigen(body.inertia).values[0], 0);
}

}  // namespace
}  // namespace limpid
