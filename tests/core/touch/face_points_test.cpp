#include "core/touch/face_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/touch/scene.h"
#include "tests/support/random_arm.h"

namespace limpid::test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

Vec3 any_way(Random& random) {
  return Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)).normalized();
}

Face plane_of(const Vec3& center, const Vec3& normal) {
  Face face{.center = center, .normal = normal};
  face.along[0] = normal.unitOrthogonal();
  face.along[1] = normal.cross(face.along[0]);
  return face;
}

// A rod whose axis rises by `rise` over a face, at a height at which a part of it is below.
Rod rod_over(Random& random, const Face& face, double rise, bool round_ends = false) {
  const double turn = random.between(-3, 3);
  const Vec3 level = std::cos(turn) * face.along[0] + std::sin(turn) * face.along[1];
  return {.center = face.center + random.between(0, 0.01) * face.normal +
                    random.between(-0.01, 0.01) * face.along[0],
          .axis = rise * face.normal + std::sqrt(1 - rise * rise) * level,
          .radius = random.between(0.005, 0.03),
          .half = random.between(0.005, 0.04),
          .round_ends = round_ends};
}

Rod moved(const Rod& rod, const Vec3& way, const Vec3& turn) {
  Rod there = rod;
  there.center += way;
  if (turn.norm() > 0) there.axis = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * rod.axis;
  return there;
}

// Energy of springs of 1 N/m at all points, and the force and torque about the centre that they
// exert.
struct Springs {
  double energy = 0;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
};
std::optional<Springs> springs_of(const std::optional<FacePoints>& found, const Vec3& center) {
  if (!found) return std::nullopt;
  Springs all;
  for (const FacePoints::Point& p : found->all()) {
    all.energy += 0.5 * p.distance * p.distance;
    all.force -= p.distance * p.normal;
    all.torque -= p.distance * (p.at - center).cross(p.normal);
  }
  return all;
}

TEST(FacePoints, OfALyingRodAreTheLowestOfBothEnds) {
  Random random(401);
  for (int i = 0; i < 40; ++i) {
    const Face face = plane_of(any_way(random), any_way(random));
    const double rise = random.between(-0.69, 0.69);
    const bool capsule = i % 2 == 1;
    const Rod rod = rod_over(random, face, rise, capsule);
    const auto found = points_on_face(rod, face, kFar);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->count, 2u);
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 end = rod.center + (k == 0 ? -1 : 1) * rod.half * rod.axis;
      const double lower = rod.radius * (capsule ? 1 : std::sqrt(1 - rise * rise));
      EXPECT_NEAR(found->points[k].distance, face.above(end) - lower, 1e-15);
      EXPECT_NEAR(face.above(found->points[k].at), found->points[k].distance, 1e-15);
      EXPECT_NEAR((found->points[k].at - end).norm(), rod.radius, 1e-15) << "it is on the rod";
    }
  }
}

TEST(FacePoints, OfAStandingCylinderAreOnItsRimWithTheLowestFirst) {
  Random random(402);
  for (int i = 0; i < 40; ++i) {
    const Face face = plane_of(any_way(random), any_way(random));
    const double rise = (i % 2 == 0 ? 1 : -1) * random.between(0.72, 1);
    const Rod rod = rod_over(random, face, rise);
    const auto found = points_on_face(rod, face, kFar);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->count, 4u);
    const Vec3 end = rod.center - std::copysign(rod.half, rise) * rod.axis;
    const double slope = rod.radius * std::sqrt(1 - rise * rise);
    EXPECT_NEAR(found->points[0].distance, face.above(end) - slope, 1e-15);
    EXPECT_NEAR(found->points[1].distance, face.above(end) + slope, 1e-15);
    for (const FacePoints::Point& p : found->all()) {
      EXPECT_NEAR((p.at - end).norm(), rod.radius, 1e-15);
      EXPECT_NEAR((p.at - end).dot(rod.axis), 0, 1e-15);
    }
  }
}

std::optional<Springs> springs_of(const Rod& rod, const Face& face) {
  return springs_of(points_on_face(rod, face, 0), rod.center);
}

std::vector<Vec2> rectangle(double x, double y) { return {{x, y}, {-x, y}, {-x, -y}, {x, -y}}; }

// A box as a hull.
struct BoxHull {
  explicit BoxHull(const Vec3& half) : faces(faces_of_box(half)) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 side((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      corners.push_back(half.cwiseProduct(side));
    }
  }
  Hull at(const Pose& pose) const {
    return {.pose = pose, .corners = corners, .center = pose.translation(), .faces = faces};
  }

  std::vector<Vec3> corners;
  std::vector<HullFace> faces;
};

// Springs at the points push as their energy falls, wherever the rod goes or turns: nothing is
// gained on the way round.
TEST(FacePoints, HoldSpringsWhoseForceIsTheSlopeOfTheirEnergy) {
  Random random(403);
  constexpr double kStep = 1e-6;
  int edges = 0;
  for (int i = 0; i < 200; ++i) {
    Face face = plane_of(any_way(random), any_way(random));
    std::vector<Vec2> outline;
    if (i % 2 == 1) {
      outline = rectangle(random.between(0.01, 0.05), 0.05);
      face.bounds = i % 4 == 1 ? Face::Bounds::polygon : Face::Bounds::circle;
      if (i % 4 == 1) face.outline = outline;
      face.radius = outline[0].x();
    }
    const bool stands = i % 5 == 0 && i % 2 == 0;
    Rod rod =
        rod_over(random, face, stands ? random.between(0.72, 0.999) : random.between(-0.3, 0.3),
                 i % 3 == 0 && !stands);
    const auto now = springs_of(rod, face);
    if (!now || now->energy == 0) continue;
    edges += face.bounds != Face::Bounds::none ? 1 : 0;
    // A round border counts as its tangent.
    const bool round = face.bounds == Face::Bounds::circle;
    const double tolerance = (round ? 0.02 : 1e-4) * now->force.norm();
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = kStep * Vec3::Unit(k);
      const auto slope = [&](const Vec3& way, const Vec3& turn) {
        const auto there = springs_of(moved(rod, way, turn), face);
        const auto back = springs_of(moved(rod, -way, -turn), face);
        EXPECT_TRUE(there && back) << i;
        return there && back ? (there->energy - back->energy) / (2 * kStep) : 0;
      };
      EXPECT_NEAR(slope(step, Vec3::Zero()), -now->force[k], tolerance) << i;
      EXPECT_NEAR(slope(Vec3::Zero(), step), -now->torque[k], tolerance * 0.04) << i;
    }
  }
  EXPECT_GT(edges, 30);
}

TEST(FacePoints, OfARodAcrossAnEdgeAreWhereBothLinesAreNearest) {
  Random random(404);
  for (int i = 0; i < 40; ++i) {
    const Pose box = Pose(Eigen::AngleAxisd(random.between(-3, 3), any_way(random)));
    const Vec3 half(0.05, 0.03, 0.02);
    // A rod that hangs over the edge at x = 0.05, with the face z = 0.02 above.
    const double turn = random.between(-0.6, 0.6), rise = random.between(-0.3, 0);
    const Vec3 axis =
        Vec3(std::cos(turn), std::sin(turn), 0) * std::sqrt(1 - rise * rise) + Vec3(0, 0, rise);
    const double r = random.between(0.004, 0.01);
    const Vec3 normal = Vec3::UnitY().cross(axis).normalized();
    const Vec3 up = normal.z() < 0 ? Vec3(-normal) : normal;
    const Vec3 touched(0.05, random.between(-0.01, 0.01), 0.02);
    const double gap = random.between(-1e-3, 1e-3);
    const Rod rod{
        .center = box * Vec3(touched + (r + gap) * up + random.between(-0.01, 0.01) * axis),
        .axis = box.linear() * axis,
        .radius = r,
        .half = 0.03};
    const BoxHull hull(half);
    const Face face = face_of_hull(rod, hull.at(box));
    EXPECT_NEAR(face.normal.dot(box.linear().col(2)), 1, 1e-12);
    const auto found = points_on_face(rod, face, 1e-3);
    ASSERT_TRUE(found) << i;
    bool seen = false;
    for (const FacePoints::Point& p : found->all()) {
      if ((p.at - p.distance * p.normal - box * touched).norm() > 1e-9) continue;
      seen = true;
      EXPECT_NEAR(p.distance, gap, 1e-12);
      EXPECT_NEAR(p.normal.dot(box.linear() * up), 1, 1e-12);
    }
    EXPECT_TRUE(seen) << i;
  }
}

TEST(FacePoints, AreNoneBesideAFaceWhichSomethingElseFinds) {
  const BoxHull half(Vec3(0.05, 0.03, 0.02));
  const Rod beside{
      .center = {0.06, 0.001, 0.0201}, .axis = Vec3::UnitY(), .radius = 0.015, .half = 0.01};
  const Face face = face_of_hull(beside, half.at(Pose::Identity()));
  EXPECT_FALSE(points_on_face(beside, face, 1e-3)) << "its lowest line is beside the top";
  const Rod above{.center = {0, 0, 0.1}, .axis = Vec3::UnitY(), .radius = 0.015, .half = 0.01};
  const auto none = points_on_face(above, face_of_hull(above, half.at(Pose::Identity())), 1e-3);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->count, 0u);
}

TEST(FacePoints, OfADiscOverACornerAreWithinBoth) {
  Random random(405);
  for (int i = 0; i < 100; ++i) {
    const bool circle = i % 2 == 0;
    Face face = plane_of(Vec3::Zero(), Vec3::UnitZ());
    const std::vector<Vec2> outline =
        rectangle(random.between(0.01, 0.04), random.between(0.01, 0.04));
    face.bounds = circle ? Face::Bounds::circle : Face::Bounds::polygon;
    if (!circle) face.outline = outline;
    face.radius = outline[0].x();
    const Rod disc{
        .center = Vec3(random.between(-0.03, 0.03), random.between(-0.03, 0.03), 0.009999),
        .axis = Vec3::UnitZ(),
        .radius = random.between(0.01, 0.03),
        .half = 0.01};
    const auto found = points_on_face(disc, face, 1e-4);
    if (!found) continue;
    ASSERT_GT(found->count, 0u);
    for (const FacePoints::Point& p : found->all()) {
      EXPECT_TRUE(face.over(p.at));
      EXPECT_LT((p.at - disc.center).head<2>().norm(), disc.radius + 1e-9);
      EXPECT_NEAR(p.distance, -1e-6, 1e-12);
    }
  }
}

TEST(FacePoints, OfAPrismAreCornersThatAreWideApart) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 24; ++i) {
    const double turn = 2 * M_PI * i / 24;
    for (const double z : {-0.02, 0.02})
      corners.emplace_back(0.03 * std::cos(turn), 0.03 * std::sin(turn), z);
  }
  const Hull prism{.pose = pose_at({0.1, 0.2, 0.02}),
                   .corners = corners,
                   .center = {0.1, 0.2, 0.02},
                   .faces = {}};
  const auto found = points_on_face(prism, plane_of(Vec3::Zero(), Vec3::UnitZ()), 1e-3);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->count, 4u);
  Vec3 middle = Vec3::Zero();
  for (const FacePoints::Point& p : found->all()) middle += p.at / 4;
  EXPECT_LT((middle - Vec3(0.1, 0.2, 0)).norm(), 1e-12) << "they make a square around the middle";
}

// Two beams that lie across each other bear in the corners of the square they share.
TEST(FacePoints, OfBeamsAcrossEachOtherAreWhereTheirEdgesCross) {
  Random random(407);
  const BoxHull beam(Vec3(0.1, 0.008, 0.005)), other(Vec3(0.1, 0.012, 0.005));
  for (int i = 0; i < 40; ++i) {
    const Pose world(Eigen::AngleAxisd(random.between(-3, 3), any_way(random)));
    const double askew = random.between(0.8, 1.5), depth = random.between(-5e-4, 5e-4);
    Pose above = pose_at({random.between(-0.02, 0.02), random.between(-0.02, 0.02), 0.01 - depth});
    above.linear() = Eigen::AngleAxisd(askew, Vec3::UnitZ()).matrix();
    const auto found = points_of_hulls(beam.at(world * above), other.at(world), 1e-3);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->count, 4u);
    for (const FacePoints::Point& p : found->all()) {
      EXPECT_NEAR(p.distance, -depth, 1e-12);
      EXPECT_NEAR(p.normal.dot(world.linear().col(2)), 1, 1e-12);
      const Vec3 on_beam = above.inverse() * (world.inverse() * p.at);
      const Vec3 on_other = world.inverse() * (p.at - p.distance * p.normal);
      EXPECT_NEAR(std::abs(on_beam.y()), 0.008, 1e-12);
      EXPECT_NEAR(std::abs(on_other.y()), 0.012, 1e-12);
      EXPECT_NEAR(on_other.z(), 0.005, 1e-12);
    }
  }
}

// An edge of a tilted plank that is parallel, from above, to an edge of the box below it lies
// beside that edge and not on it.
TEST(FacePoints, OfATiltedPlankAreNotBesideEdgesOfTheBox) {
  const BoxHull box(Vec3(0.05, 0.05, 0.01)), plank(Vec3(0.03, 0.01, 0.005));
  for (const double yaw : {0.0, 1e-3, -1e-3, 0.02, -0.02}) {
    Pose at = pose_at({0, 0.05, 0});
    at.linear() =
        (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(0.35, Vec3::UnitY())).matrix();
    double low = 1;
    for (const Vec3& corner : plank.corners) low = std::min(low, (at * corner).z());
    at.translation().z() = -low - 0.0005;
    const auto found = points_of_hulls(plank.at(at), box.at(pose_at({0, 0, -0.01})), 1e-3);
    ASSERT_TRUE(found) << yaw;
    ASSERT_GT(found->count, 0u) << yaw;
    for (const FacePoints::Point& p : found->all()) {
      EXPECT_GT(p.distance, -6e-4) << yaw;
      EXPECT_GT(p.normal.z(), 0.8) << yaw;
    }
  }
}

TEST(FacePoints, OfHullsHoldSpringsWhoseForceIsTheSlopeOfTheirEnergy) {
  Random random(408);
  constexpr double kStep = 1e-7;
  int pressed = 0, crossed = 0;
  for (int i = 0; i < 200; ++i) {
    const BoxHull below(Vec3(random.between(0.01, 0.06), random.between(0.01, 0.06), 0.01));
    const BoxHull above(Vec3(random.between(0.01, 0.06), random.between(0.01, 0.06), 0.01));
    const Pose world(Eigen::AngleAxisd(random.between(-3, 3), any_way(random)));
    Pose at = pose_at({random.between(-0.04, 0.04), random.between(-0.04, 0.04), 0.0195});
    at.linear() = (Eigen::AngleAxisd(random.between(-3, 3), Vec3::UnitZ()) *
                   Eigen::AngleAxisd(random.between(0, 0.02), any_way(random)))
                      .matrix();
    const Pose here = world * at;
    const auto springs = [&](const Vec3& way, const Vec3& turn) {
      Pose there = here;
      there.translation() += way;
      if (turn.norm() > 0)
        there.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * here.linear();
      return springs_of(points_of_hulls(above.at(there), below.at(world), 0), here.translation());
    };
    const auto now = springs(Vec3::Zero(), Vec3::Zero());
    if (!now || now->energy == 0) continue;
    ++pressed;
    const auto points = points_of_hulls(above.at(here), below.at(world), 0);
    for (const FacePoints::Point& p : points->all())
      crossed += std::abs(p.normal.dot(world.linear().col(2))) < 1 - 1e-12 ? 1 : 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = kStep * Vec3::Unit(k);
      const auto slope = [&](const Vec3& way, const Vec3& turn) {
        const auto there = springs(way, turn), back = springs(-way, -turn);
        EXPECT_TRUE(there && back) << i;
        return there && back ? (there->energy - back->energy) / (2 * kStep) : 0;
      };
      EXPECT_NEAR(slope(step, Vec3::Zero()), -now->force[k], 1e-4 * now->force.norm()) << i;
      EXPECT_NEAR(slope(Vec3::Zero(), step), -now->torque[k], 4e-6 * now->force.norm()) << i;
    }
  }
  EXPECT_GT(pressed, 100);
  EXPECT_GT(crossed, 50);
}

TEST(FacePoints, OfAFaceOfAHullHaveItsCornersInTheirOrder) {
  std::vector<Vec3> corners;
  for (const double z : {-0.02, 0.02}) {
    for (const int i : {3, 0, 5, 1, 4, 2}) {
      const double turn = 2 * M_PI * i / 6;
      corners.emplace_back(0.03 * std::cos(turn), 0.02 * std::sin(turn), z);
    }
  }
  corners.emplace_back(0, 0, 0.02);
  corners.push_back(0.5 * (corners[6] + corners[7]));
  const HullFace top = hull_face(corners, Vec3::UnitZ(), 1e-9);
  EXPECT_NEAR(top.center.z(), 0.02, 1e-15);
  ASSERT_EQ(top.outline.size(), 6u) << "without what lies within, or on an edge";
  double area = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec2 &a = top.outline[i], &b = top.outline[(i + 1) % 6];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(area, 0.03 * 0.02 * 6 * std::sin(M_PI / 3) / 2, 1e-12);
}

TEST(FacePoints, OfAnEndAreForWhatIsAboveItNotBeside) {
  const Rod post{.center = Vec3::Zero(), .axis = Vec3::UnitZ(), .radius = 0.02, .half = 0.05};
  const Rod on{.center = {0.005, 0, 0.06}, .axis = Vec3::UnitX(), .radius = 0.01, .half = 0.03};
  const auto end = end_of_cylinder(on, post);
  ASSERT_TRUE(end);
  EXPECT_LT((end->center - Vec3(0, 0, 0.05)).norm(), 1e-15);
  const Rod beside{.center = {0.03, 0, 0.02}, .axis = Vec3::UnitZ(), .radius = 0.01, .half = 0.03};
  EXPECT_FALSE(end_of_cylinder(beside, post));
}

}  // namespace
}  // namespace limpid::test
