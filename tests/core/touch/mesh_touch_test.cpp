// A ball on surfaces whose contact force has a closed form.
#include "core/touch/mesh_touch.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/meshes.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using test::Triangles;

using test::T;

// Pull at the ball's centre: force over stiffness [m].
Vec3 pull(const MeshTouch& touch, const Vec3& c) {
  if (touch.held()) return touch.anchor() - c;
  if (!touch.near()) return Vec3::Zero();
  Vec3 x;
  FreeSpace::Active active;
  EXPECT_TRUE(touch.space().project(c, x, active));
  return x - c;
}

// Moves the ball to `to` in steps of at most `step`, and stays a tick.
void go(MeshTouch& touch, Vec3& c, const Vec3& to, double step) {
  const Vec3 from = c;
  const int count = static_cast<int>(std::ceil((to - from).norm() / step));
  for (int i = 1; i <= count; ++i) {
    c = from + static_cast<double>(i) / count * (to - from);
    touch.follow(c, T);
  }
  touch.follow(c, T);
}

Pose some_pose(Random& random, double size) {
  Pose pose = Pose::Identity();
  pose.linear() = random.rotation();
  pose.translation() = random.point(size);
  return pose;
}

TEST(Ball, OnAFlatSheetIsAsDeepAsItOverlaps) {
  Random random(321);
  for (const double size : {1e-3, 0.1, 10.0}) {
    for (const double radius : {0.01 * size, 0.1 * size}) {
      for (const int cells : {1, 20}) {
        Object sheet = test::obstacle(test::sheet(cells, 1));
        test::mesh_of(sheet).scale = size;
        for (const double side : {1.0, -1.0}) {
          MeshTouch touch(sheet, radius);
          Vec3 c(0.03 * size, 0.11 * size, side * 2 * radius);
          touch.place(c);
          for (int round = 0; round < 20; ++round) {
            const double height = random.between(-2, 1) * radius;
            go(touch, c,
               Vec3(random.between(-0.3, 0.3) * size, random.between(-0.3, 0.3) * size,
                    side * height),
               0.05 * radius);
            const Vec3 wanted = std::max(0.0, radius - height) * side * Vec3::UnitZ();
            ASSERT_LT((pull(touch, c) - wanted).norm(), 1e-12 * size);
            ASSERT_FALSE(touch.held());
          }
        }
      }
    }
  }
}

TEST(Ball, OnAFineSphereIsPushedOutOfItsMiddle) {
  const Triangles sphere = test::icosphere(5);  // facets 4e-2 across, 3e-4 beneath the sphere
  Object obstacle = test::obstacle(sphere);
  test::mesh_of(obstacle).scale = 0.05;
  obstacle.pose.translation() = Vec3(0.2, -0.1, 0.05);
  Random random(322);
  for (const double radius : {0.0, 0.001, 0.01, 0.1}) {
    MeshTouch touch(obstacle, radius);
    const double rest = 0.05 + radius;
    Vec3 c = obstacle.pose.translation() + 2 * rest * random.direction();
    touch.place(c);
    for (int round = 0; round < 50; ++round) {
      // A goal around the sphere, no deeper than 2 mm.
      const Vec3 out = (c - obstacle.pose.translation() + 0.5 * rest * random.direction());
      const double depth = random.between(-0.001, 0.002);
      const Vec3 goal = obstacle.pose.translation() + (rest - depth) * out.normalized();
      for (int i = 0; i < 400; ++i) {
        c += std::min(2e-4, (goal - c).norm()) * (goal - c).normalized();
        c = obstacle.pose.translation() +
            std::max((c - obstacle.pose.translation()).norm(), rest - 0.002) *
                (c - obstacle.pose.translation()).normalized();
        if ((goal - c).norm() == 0) break;
        touch.follow(c, T);
        const Vec3 from = c - obstacle.pose.translation();
        const double overlap = std::max(0.0, rest - from.norm());
        // Bounds: the facets lie beneath the sphere and are tilted against it.
        ASSERT_NEAR(pull(touch, c).norm(), overlap, 2e-5 + 0.02 * overlap);
        const double askew = 0.03 * overlap + 0.02 * (radius > 0 ? 0 : overlap);
        ASSERT_LT((pull(touch, c) - overlap * from.normalized()).norm(), 2e-5 + askew);
      }
    }
  }
}

TEST(Ball, RollsOverAConvexEdgeAndItsCorner) {
  Random random(323);
  Object cube = test::obstacle(test::box(Vec3(0.1, 0.1, 0.1)));
  cube.pose = some_pose(random, 0.1);
  constexpr double kRadius = 0.005;
  MeshTouch touch(cube, kRadius);
  // The path follows the surface of the rounded cube, in by 0.2 of the radius: over faces, edges
  // and corners.
  Vec3 direction = Vec3::UnitZ();
  const auto nearest_of = [&](const Vec3& p) { return Vec3(p.cwiseMax(-0.05).cwiseMin(0.05)); };
  Vec3 local(0, 0, 0.08);
  touch.place(cube.pose * local);
  int edges = 0, corners = 0;
  for (int k = 0; k < 30000; ++k) {
    const Vec3 before = local;
    if (k % 500 == 0) direction = random.direction();
    local += 1e-4 * direction;
    const Vec3 foot = nearest_of(local);
    if (foot == local) {  // it went in: goes out again
      direction = local.normalized();
      local += 5e-4 * direction;
    }
    const Vec3 on = nearest_of(local);
    const Vec3 out = (local - on).norm() > 0 ? Vec3((local - on).normalized()) : direction;
    const double height = std::clamp((local - on).norm(), 0.8 * kRadius, 1.3 * kRadius);
    if ((local - on).norm() > 2 * kRadius) direction = -local.normalized();
    local = on + height * out;
    touch.follow(cube.pose * local, T);
    const Vec3 wanted = std::max(0.0, kRadius - height) * out;
    const Vec3 found = cube.pose.linear().transpose() * pull(touch, cube.pose * local);
    // In motion the touch takes one iteration a tick, which leaves a part of the error: the depth
    // in radii.
    const double step = (local - before).norm();
    const double askew = 1.3 * step / (0.8 * kRadius) * 0.2;
    ASSERT_LT((found - wanted).norm(), 1e-7 + askew * wanted.norm()) << k;
    if (k % 20 == 0) {
      for (int rest = 0; rest < 10; ++rest) touch.follow(cube.pose * local, T);
      const Vec3 rested = cube.pose.linear().transpose() * pull(touch, cube.pose * local);
      ASSERT_LT((rested - wanted).norm(), 1e-7) << k;
    }
    const auto beyond = (local.cwiseAbs().array() > 0.05).count();
    edges += beyond == 2 ? 1 : 0;
    corners += beyond == 3 ? 1 : 0;
  }
  EXPECT_GT(edges, 500);
  EXPECT_GT(corners, 20);
}

// Two half planes that meet in the y axis and rise by `slope` [rad] on both sides.
Triangles groove(double slope, int cells) {
  return test::height_field(2 * cells, 0.2,
                            [&](double x, double) { return std::tan(slope) * std::abs(x); });
}

TEST(Ball, InAGrooveIsHeldByBothOfItsSides) {
  Random random(324);
  for (const double slope : {0.05, 0.5, 1.2}) {
    for (const double radius : {0.0, 0.002, 0.02}) {
      const Triangles triangles = groove(slope, 3);
      Object obstacle = test::obstacle(triangles);
      obstacle.pose = some_pose(random, 0.1);
      // The two offset planes meet at the bottom; a point without a size stays a little off the
      // surface.
      const double bottom = radius / std::cos(slope);
      const double skin = 1.1e-5 * test::mesh_of(obstacle).triangles->radius() / std::cos(slope);
      MeshTouch touch(obstacle, radius);
      Vec3 c = obstacle.pose * Vec3(0.001, 0.013, bottom + 0.03);
      touch.place(c);
      for (int round = 0; round < 50; ++round) {
        // A place beneath the bottom, where both sides push.
        const double depth = random.between(0.0005, 0.005);
        const double lateral = random.between(-0.9, 0.9) * depth * std::tan(slope);
        const Vec3 local(lateral, random.between(-0.02, 0.02), bottom - depth);
        go(touch, c, obstacle.pose * local, 1e-4);
        const Vec3 wanted(-lateral, 0, depth);
        const Vec3 found = obstacle.pose.linear().transpose() * pull(touch, c);
        ASSERT_LT((found - wanted).norm(), 1e-7 + (radius == 0 ? 3 * skin : 0))
            << slope << ' ' << radius << ' ' << round << " held " << touch.held();
        ASSERT_FALSE(touch.held());
      }
    }
  }
}

TEST(Ball, InACornerOfThreeStaysThere) {
  Random random(325);
  Triangles corner;  // the inside of the corner of a room
  corner.vertices = {{0, 0, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}, {0, 0, 0.2f}};
  corner.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1};
  Object obstacle = test::obstacle(corner);
  obstacle.pose = some_pose(random, 0.1);
  for (const double radius : {0.0, 0.003}) {
    const double off = std::max(radius, 1e-5 * test::mesh_of(obstacle).triangles->radius());
    MeshTouch touch(obstacle, radius);
    Vec3 c = obstacle.pose * Vec3(0.02, 0.02, 0.02);
    touch.place(c);
    for (int round = 0; round < 50; ++round) {
      Vec3 local = random.point(0.004);
      go(touch, c, obstacle.pose * local, 1e-4);
      const Vec3 wanted = (off - local.array()).max(0);
      const Vec3 found = obstacle.pose.linear().transpose() * pull(touch, c);
      ASSERT_LT((found - wanted).norm(), 2e-7) << round;
    }
  }
}

// A flat square, divided at random.
Triangles divided_square(int points, double size, Random& random) {
  Triangles out;
  const float h = static_cast<float>(size / 2);
  out.vertices = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  out.indices = {0, 1, 2, 0, 2, 3};
  while (points-- > 0) {  // a point in a triangle divides it into three
    const auto t =
        3 * static_cast<std::size_t>(random.between(0, static_cast<double>(out.count()) - 0.01));
    const std::uint32_t a = out.indices[t], b = out.indices[t + 1], c = out.indices[t + 2];
    const double u = random.between(0.1, 0.8), v = random.between(0.1, 0.9 - u);
    const auto next = static_cast<std::uint32_t>(out.vertices.size());
    const Vec3 p =
        (1 - u - v) * out.corner(t / 3, 0) + u * out.corner(t / 3, 1) + v * out.corner(t / 3, 2);
    out.vertices.push_back(p.cast<float>());
    out.indices[t + 2] = next;
    out.add(b, c, next);
    out.add(c, a, next);
  }
  return out;
}

TEST(Ball, OnAFlatSurfaceDoesNotFeelItsTriangles) {
  Random random(326);
  std::vector<MeshTouch> touches;
  for (const double radius : {0.0, 0.001, 0.01}) {
    touches.clear();
    for (const int points : {0, 3, 30, 300, 3000}) {
      touches.emplace_back(test::obstacle(divided_square(points, 0.2, random)), radius);
    }
    Vec3 c(0, 0, radius + 0.004), velocity = Vec3::Zero();
    for (MeshTouch& touch : touches) touch.place(c);
    for (int k = 0; k < 3000; ++k) {
      velocity = 0.98 * velocity + random.point(2e-5) - 2e-4 * (c - Vec3(0, 0, radius));
      c += velocity;
      for (MeshTouch& touch : touches) touch.follow(c, T);
      const Vec3 first = pull(touches.front(), c);
      for (MeshTouch& touch : touches) ASSERT_LT((pull(touch, c) - first).norm(), 1e-14) << k;
    }
  }
}

TEST(Ball, FeelsTheSameWhereverTheWorldIsAndWhicheverWayItIsTurned) {
  Random random(327);
  const Triangles body = test::bumpy_body(4, 0.3);
  const Object still = test::obstacle(body);
  for (const double scale : {0.01, 1.0, 7.0}) {
    Object turned = still;
    turned.pose = some_pose(random, 1);
    test::mesh_of(turned).scale = scale * test::mesh_of(still).scale;
    for (const double radius : {0.0, 0.02}) {
      MeshTouch here(still, radius), there(turned, scale * radius);
      const auto map = [&](const Vec3& p) { return Vec3(turned.pose * Vec3(scale * p)); };
      // A path over hills and through valleys, in by half the ball's radius at most.
      const auto at = [&](double t) {
        const Vec3 d = Vec3(std::sin(t), std::cos(1.3 * t), std::sin(0.7 * t + 1)).normalized();
        return Vec3((test::bumpy_radius(d, 0.3) + radius + 0.01 * std::sin(9 * t)) * d);
      };
      here.place(at(0)), there.place(map(at(0)));
      double difference = 0;
      int touching = 0;
      for (int k = 0; k < 6000; ++k) {
        const Vec3 c = at(1e-3 * k);
        here.follow(c, T), there.follow(map(c), scale * T);  // slips in proportion to its size
        const Vec3 mine = pull(here, c);
        const Vec3 theirs = turned.pose.linear().transpose() * pull(there, map(c)) / scale;
        touching += mine.norm() > 0 ? 1 : 0;
        difference = std::max(difference, (mine - theirs).norm());
      }
      // The distance at which the ball counts as on the surface.
      EXPECT_LT(difference, 1e-5) << scale << ' ' << radius;
      EXPECT_GT(touching, 1000);
    }
  }
}

// The mesh moves with the body that carries it; relative to the ball it stands still.
TEST(Ball, GoesAlongWithAMeshThatCarriesItHoweverFast) {
  const Object object = test::obstacle(test::box(Vec3::Constant(0.04)));
  MeshTouch touch(object, 0.004);
  const Vec3 on_top(0.003, 0.005, 0.023);  // a millimetre deep
  touch.place(Vec3(0.003, 0.005, 0.03));
  Vec3 c(0.003, 0.005, 0.03);
  go(touch, c, on_top, 1e-4);
  const Vec3 before = pull(touch, c);
  EXPECT_NEAR(before.z(), 0.001, 1e-6);
  Pose pose = Pose::Identity();
  for (int k = 0; k < 300; ++k) {
    pose.translation() += Vec3(5e-4, 0, 2e-4);  // half a metre in a second
    pose.rotate(Eigen::AngleAxisd(0.008, Vec3(1, 2, 0).normalized()));
    touch.move(pose);
    touch.follow(pose * on_top, T);
    ASSERT_FALSE(touch.held()) << k;
    ASSERT_LT((pose.linear().transpose() * pull(touch, pose * on_top) - before).norm(), 1e-8) << k;
  }
}

TEST(Ball, ThroughASheetCouldNotFindItsSideAgain) {
  // Beyond half its radius the nearest side of an open sheet may be the wrong one; a closed body's
  // side is known.
  constexpr double kRadius = 0.004;
  const auto pressed = [&](const Triangles& triangles, double top, double depth) {
    MeshTouch touch(test::obstacle(triangles), kRadius);
    Vec3 c(0.003, 0.007, top + 2 * kRadius);
    touch.place(c);
    go(touch, c, Vec3(0.004, 0.006, top + kRadius - depth), 1e-4);
    EXPECT_FALSE(touch.held());
    EXPECT_NEAR(pull(touch, c).z(), depth, 1e-8);  // corners are floats
    return touch.recoverable();
  };
  const Triangles sheet = test::sheet(9, 0.2), cube = test::box(Vec3(0.2, 0.2, 0.2));
  EXPECT_TRUE(pressed(sheet, 0, 0.0019));
  EXPECT_FALSE(pressed(sheet, 0, 0.0021));
  EXPECT_FALSE(pressed(sheet, 0, 0.0075));
  EXPECT_TRUE(pressed(cube, 0.1, 0.0075));
}

}  // namespace
}  // namespace limpid
