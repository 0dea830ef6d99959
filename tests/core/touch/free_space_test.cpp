// The nearest point of a room of planes, against Dykstra's alternating projections and against the
// conditions that determine it.
#include "core/touch/free_space.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"
#include "tests/support/singular_values.h"

namespace limpid {
namespace {

using test::Random;

struct HalfSpace {
  Vec3 normal;
  double offset;
};

FreeSpace room(const std::vector<HalfSpace>& planes) {
  FreeSpace space;
  for (const HalfSpace& p : planes) EXPECT_TRUE(space.add(p.normal, p.offset));
  return space;
}

// Converges to the projection onto the intersection, slowly.
Vec3 dykstra(const std::vector<HalfSpace>& planes, const Vec3& c, int rounds) {
  Vec3 x = c;
  std::vector<double> given(planes.size(), 0);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const double missing = planes[i].offset - planes[i].normal.dot(x);
      const double next = std::max(0.0, given[i] + missing);
      x += (next - given[i]) * planes[i].normal;
      given[i] = next;
    }
  }
  return x;
}

// Planes that all leave room around a common point.
std::vector<HalfSpace> some_planes(int count, Random& random, double size) {
  std::vector<HalfSpace> planes;
  const Vec3 free = random.point(size);
  for (int i = 0; i < count; ++i) {
    const Vec3 n = random.direction();
    planes.push_back({n, n.dot(free) - random.between(0, size)});
  }
  return planes;
}

TEST(FreeSpace, GivesThePointThatAlternatingProjectionsConvergeTo) {
  Random random(311);
  int compared = 0;
  for (int round = 0; round < 3000; ++round) {
    const int count = 1 + round % FreeSpace::kMostPlanes;
    const auto planes = some_planes(count, random, 1);
    const Vec3 c = random.point(3);
    Vec3 x = c;
    FreeSpace::Active active;
    ASSERT_TRUE(room(planes).project(c, x, active));
    const Vec3 wanted = dykstra(planes, c, 2000);
    if ((dykstra(planes, c, 1000) - wanted).norm() > 1e-10) continue;  // Dykstra has not converged
    EXPECT_LT((x - wanted).norm(), 1e-8);
    ++compared;
  }
  EXPECT_GT(compared, 2500);
}

TEST(FreeSpace, PushesOnlyOutwardsAndOnlyWithPlanesThatHold) {
  Random random(312);
  for (int round = 0; round < 20000; ++round) {
    const double size = std::pow(10.0, random.between(-3, 1));
    const auto planes = some_planes(1 + round % FreeSpace::kMostPlanes, random, size);
    const FreeSpace space = room(planes);
    const Vec3 c = random.point(3 * size);
    Vec3 x = c;
    FreeSpace::Active active;
    ASSERT_TRUE(space.project(c, x, active));
    for (const HalfSpace& p : planes) ASSERT_GE(p.normal.dot(x) - p.offset, -1e-8 * size);
    // x - c is a sum of active normals with weights that are not negative.
    ASSERT_LE(active.count, 3);
    Eigen::Matrix<double, 3, Eigen::Dynamic> normals(3, active.count);
    for (int i = 0; i < active.count; ++i) {
      const int plane = active.plane[static_cast<std::size_t>(i)];
      normals.col(i) = space.normal(plane);
      ASSERT_NEAR(space.normal(plane).dot(x), space.offset(plane), 1e-12 * size);
    }
    if (active.count == 0) {
      ASSERT_EQ(x, c);
      continue;
    }
    const Eigen::VectorXd weights = least_squares(normals, x - c);
    const double strain = 1 / test::singular_values(normals)[0];
    ASSERT_LT((normals * weights - (x - c)).norm(), 1e-12 * strain * size);
    ASSERT_GE(weights.minCoeff(), -1e-12 * strain * strain * size);
    ASSERT_LT((space.onto(c, active) - x).norm(), 1e-15 * size);
    // The orthonormal basis of the active normals spans the force.
    Mat3 e;
    const int rank = space.basis(active, e);
    ASSERT_EQ(rank, active.count);
    const Eigen::MatrixXd basis = e.leftCols(rank);
    const Eigen::MatrixXd gram = basis.transpose() * basis;
    ASSERT_TRUE(gram.isIdentity(1e-9));
    const Vec3 along = basis * (basis.transpose() * (x - c));
    ASSERT_LT((along - (x - c)).norm(), 1e-9 * size);
  }
}

TEST(FreeSpace, MovesThePointNoFurtherThanTheCentre) {
  Random random(313);
  for (int round = 0; round < 5000; ++round) {
    const FreeSpace space = room(some_planes(1 + round % FreeSpace::kMostPlanes, random, 1));
    Vec3 c = random.point(2), x = c;
    FreeSpace::Active active;
    ASSERT_TRUE(space.project(c, x, active));
    for (int step = 0; step < 10; ++step) {
      const Vec3 before = c, x_before = x;
      c += random.point(0.1);
      ASSERT_TRUE(space.project(c, x, active));
      ASSERT_LE((x - x_before).norm(), (c - before).norm() + 1e-12);
    }
  }
}

TEST(FreeSpace, TakesParallelPlanesAsTheOneThatIsFurtherOut) {
  Random random(314);
  for (int round = 0; round < 20000; ++round) {
    const double size = std::pow(10.0, random.between(-3, 1));
    const Vec3 n = random.direction(), c = random.point(size);
    const double offset = n.dot(c) + random.between(0.1, 1) * size;
    // Adds the plane again: the same, one beneath, and one tilted by less than can be told.
    const double askew = std::pow(10.0, random.between(-17, -3));
    const Vec3 almost = (n + askew * n.unitOrthogonal()).normalized();
    const FreeSpace space = room({{n, offset - 0.05 * size},
                                  {n, offset},
                                  {almost, almost.dot(c + (offset - n.dot(c)) * n)},
                                  {n, offset}});
    Vec3 x = c;
    FreeSpace::Active active;
    ASSERT_TRUE(space.project(c, x, active)) << askew;
    ASSERT_LT((x - (c + (offset - n.dot(c)) * n)).norm(), 2 * askew * size + 1e-13 * size);
  }
}

TEST(FreeSpace, HoldsBetweenNearlyParallelPlanes) {
  // Two facets of a surface that is flat but for rounding, pressed deep.
  Random random(315);
  for (int round = 0; round < 20000; ++round) {
    const double askew = std::pow(10.0, random.between(-9, -2));
    const Vec3 n = random.direction(), side = n.unitOrthogonal();
    const Vec3 other = (n + askew * side).normalized();
    const Vec3 at = random.point(1);
    const FreeSpace space = room({{n, n.dot(at)}, {other, other.dot(at)}});
    const Vec3 c = at - random.between(0, 1) * n + random.between(-1, 1) * side;
    Vec3 x = c;
    FreeSpace::Active active;
    ASSERT_TRUE(space.project(c, x, active)) << askew;
    ASSERT_GE(n.dot(x - at), -1e-8);
    ASSERT_GE(other.dot(x - at), -1e-8);
    ASSERT_LT((x - c).norm(), 1.01 * (c - at).norm());
  }
}

TEST(FreeSpace, SaysSoWhenPlanesLeaveNothing) {
  const FreeSpace space = room({{Vec3::UnitZ(), 0.1}, {-Vec3::UnitZ(), 0.1}});
  Vec3 x;
  FreeSpace::Active active{{1, 0, 0}, 1};
  EXPECT_FALSE(space.project(Vec3(1, 2, 3), x, active));
  EXPECT_EQ(x, Vec3(1, 2, 3));
  EXPECT_EQ(active.count, 0);
}

TEST(FreeSpace, HasRoomForSixPlanes) {
  FreeSpace space;
  for (int i = 0; i < FreeSpace::kMostPlanes; ++i) EXPECT_TRUE(space.add(Vec3::UnitX(), i));
  EXPECT_FALSE(space.add(Vec3::UnitY(), 0));
  EXPECT_EQ(space.count(), FreeSpace::kMostPlanes);
  space.clear();
  EXPECT_EQ(space.count(), 0);
  Vec3 x;
  FreeSpace::Active active;
  EXPECT_TRUE(space.project(Vec3(1, 2, 3), x, active));
  EXPECT_EQ(x, Vec3(1, 2, 3));
}

TEST(FreeSpace, HasAnOrthonormalBasisOfNearlyParallelPlanes) {
  Random random(316);
  for (int round = 0; round < 3000; ++round) {
    const double askew = std::pow(10.0, random.between(-8, -3));
    const Vec3 n = random.direction(), side = n.unitOrthogonal();
    const Vec3 second = (n + askew * side).normalized();
    const Vec3 third = (n + askew * random.between(0.3, 1) * n.cross(side)).normalized();
    const FreeSpace space = room({{n, 0}, {second, 0}, {third, 0}});
    Mat3 e;
    ASSERT_EQ(space.basis({{0, 1, 2}, 3}, e), 3);
    ASSERT_LT((e.transpose() * e - Mat3::Identity()).norm(), 1e-14) << askew;
    // The first column is the first normal, and each turns towards its own plane's.
    ASSERT_LT((e.col(0) - n).norm(), 1e-15);
    ASSERT_GT(e.col(1).dot(second), 0);
    ASSERT_GT(e.col(2).dot(third), 0);
  }
}

}  // namespace
}  // namespace limpid
