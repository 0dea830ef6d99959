// Distances to cylinders and capsules, against many points of their surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/touch/contacts.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

constexpr int kRound = 180, kAlong = 60;

Vec3 on_ring(double r, double z, int i) {
  const double angle = 2 * std::numbers::pi * i / kRound;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

std::vector<Vec3> surface_of(const Cylinder& cylinder) {
  std::vector<Vec3> all;
  for (int i = 0; i < kRound; ++i) {
    for (int j = 0; j <= kAlong; ++j) {
      const double part = static_cast<double>(j) / kAlong;
      all.push_back(on_ring(cylinder.radius, (part - 0.5) * cylinder.length, i));
      for (const double end : {-0.5, 0.5}) {
        all.push_back(on_ring(part * cylinder.radius, end * cylinder.length, i));
      }
    }
  }
  return all;
}

std::vector<Vec3> surface_of(const Capsule& capsule) {
  std::vector<Vec3> all;
  for (int i = 0; i < kRound; ++i) {
    for (int j = 0; j <= kAlong; ++j) {
      const double part = static_cast<double>(j) / kAlong;
      all.push_back(on_ring(capsule.radius, (part - 0.5) * capsule.length, i));
      const double up = part * std::numbers::pi / 2;
      for (const double end : {-1.0, 1.0}) {
        const double z = end * (capsule.length / 2 + capsule.radius * std::sin(up));
        all.push_back(on_ring(capsule.radius * std::cos(up), z, i));
      }
    }
  }
  return all;
}

bool inside(const Cylinder& c, const Vec3& p) {
  return p.head<2>().norm() < c.radius && std::abs(p.z()) < c.length / 2;
}
bool inside(const Capsule& c, const Vec3& p) {
  const double beyond = std::max(0.0, std::abs(p.z()) - c.length / 2);
  return Vec3(p.x(), p.y(), beyond).norm() < c.radius;
}

Pose random_pose(Random& random) {
  Pose pose = Pose::Identity();
  pose.linear() = random.rotation();
  pose.translation() = random.point(0.3);
  return pose;
}

// Samples of the surface; each of its points is within `spacing` of one of them [m].
template <class S>
void expect_distance(const S& shape, double spacing) {
  Random random(11);
  const std::vector<Vec3> surface = surface_of(shape);
  int within = 0;
  for (int round = 0; round < 300; ++round) {
    const Pose pose = random_pose(random);
    const Vec3 local = random.point(0.08), point = pose * local;
    double sampled = std::numeric_limits<double>::infinity();
    for (const Vec3& each : surface) sampled = std::min(sampled, (each - local).norm());
    const Surface found = distance_to(shape, pose, point);
    EXPECT_EQ(found.distance < 0, inside(shape, local));
    EXPECT_LE(std::abs(found.distance), sampled + 1e-12);
    EXPECT_GE(std::abs(found.distance), sampled - spacing);
    EXPECT_NEAR(found.normal.norm(), 1, 1e-12);
    const Vec3 foot = point - found.distance * found.normal;
    EXPECT_NEAR(distance_to(shape, pose, foot).distance, 0, 1e-12);
    const Vec3 further = point + 0.01 * found.normal;
    if (found.distance > 0) {
      EXPECT_NEAR(distance_to(shape, pose, further).distance, found.distance + 0.01, 1e-12);
    }
    within += found.distance < 0 ? 1 : 0;
  }
  EXPECT_GT(within, 20);
}

TEST(TubeDistance, OfACylinderIsToTheNearestOfItsPoints) {
  expect_distance(Cylinder{0.04, 0.07}, 0.002);
  expect_distance(Cylinder{0.07, 0.03}, 0.003);
}

TEST(TubeDistance, OfACapsuleIsToTheNearestOfItsPoints) {
  expect_distance(Capsule{0.04, 0.07}, 0.002);
  expect_distance(Capsule{0.05, 0.01}, 0.002);
}

template <class S>
void expect_a_normal_on_the_axis(const S& shape) {
  Random random(12);
  const Pose pose = random_pose(random);
  for (const double z : {-0.1, 0.0, 0.01, 0.1}) {
    const Surface found = distance_to(shape, pose, pose * Vec3(0, 0, z));
    EXPECT_NEAR(found.normal.norm(), 1, 1e-12) << z;
    EXPECT_TRUE(std::isfinite(found.distance)) << z;
  }
}

TEST(TubeDistance, HasANormalOnTheAxis) {
  expect_a_normal_on_the_axis(Cylinder{0.04, 0.07});
  expect_a_normal_on_the_axis(Capsule{0.04, 0.07});
}

template <class S>
void expect_nearest(const S& shape) {
  Random random(13);
  for (int round = 0; round < 200; ++round) {
    const Pose pose = random_pose(random);
    const Vec3 from = pose * random.point(0.15), to = pose * random.point(0.15);
    const Vec3 found = nearest_on_segment(shape, pose, from, to);
    const double s = (to - from).dot(found - from) / (to - from).squaredNorm();
    EXPECT_LT((from + s * (to - from) - found).norm(), 1e-12);
    EXPECT_GE(s, -1e-12);
    EXPECT_LE(s, 1 + 1e-12);
    const double least = distance_to(shape, pose, found).distance;
    for (int i = 0; i <= 200; ++i) {
      const Vec3 other = from + i / 200.0 * (to - from);
      EXPECT_GE(distance_to(shape, pose, other).distance, least - 1e-9);
    }
  }
}

TEST(TubeDistance, OfASegmentIsThatOfItsNearestPoint) {
  expect_nearest(Cylinder{0.04, 0.07});
  expect_nearest(Capsule{0.03, 0.06});
}

}  // namespace
}  // namespace limpid
