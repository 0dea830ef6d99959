// A point among plain solids: the side by which it came in, and the faces that other solids cover.
#include "core/touch/solid_touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/touch/free_space.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

Pose turned_at(const Mat3& turned, const Vec3& middle) {
  Pose pose = Pose::Identity();
  pose.linear() = turned;
  pose.translation() = middle;
  return pose;
}

// The near solids that count.
std::vector<SolidTouch::Near> counting(SolidTouch& touch, const std::vector<Solid>& solids,
                                       const Vec3& point) {
  std::vector<SolidTouch::Near> out;
  for (const auto& near : touch.find(solids, point, point)) {
    if (near.counts) out.push_back(near);
  }
  return out;
}

TEST(SolidTouch, HoldsAPointThatGoesThroughABoardByTheFaceThatItCameInBy) {
  Random random(41);
  for (int round = 0; round < 300; ++round) {
    const Mat3 turned = random.rotation();
    const double thick = random.between(5e-4, 0.01);
    const Pose pose = turned_at(turned, random.point(0.1));
    std::vector<Solid> solids(1);
    if (round % 2 == 0) {
      solids[0] = {Box{Vec3(0.1, 0.1, thick)}, pose, {}};
    } else {
      solids[0] = {Cylinder{0.05, thick}, pose, {}};
    }
    const double side = round % 4 < 2 ? 1 : -1;
    SolidTouch touch(0, 1);
    const Vec3 at(random.between(-0.01, 0.01), random.between(-0.01, 0.01), 0);
    const double step = random.between(1e-5, 0.01);  // up to 10 m/s
    for (double height = 0.015; height > -0.015; height -= step) {
      const Vec3 point = pose * Vec3(at + side * (height + thick / 2) * Vec3::UnitZ());
      const auto near = counting(touch, solids, point);
      ASSERT_EQ(near.size(), 1u);
      EXPECT_NEAR(near[0].surface.distance, height, 1e-12);
      EXPECT_NEAR(near[0].surface.normal.dot(turned.col(2)), side, 1e-12);
    }
    EXPECT_FALSE(touch.recoverable());
    touch.forget();
    const auto anew = counting(touch, solids, pose * Vec3(at - side * 0.0151 * Vec3::UnitZ()));
    ASSERT_EQ(anew.size(), 1u);
    EXPECT_NEAR(anew[0].surface.normal.dot(turned.col(2)), -side, 1e-12);
    EXPECT_TRUE(touch.recoverable());
  }
}

TEST(SolidTouch, LetsAPointGoThatHasLeftTheBoardSideways) {
  const std::vector<Solid> solids{{Box{Vec3(0.1, 0.1, 0.002)}, Pose::Identity(), {}}};
  SolidTouch touch(0, 1);
  double x = 0.04;
  for (double z = 0.005; z > -0.008; z -= 5e-4) counting(touch, solids, Vec3(x, 0, z));
  for (; x < 0.05; x += 5e-4) {
    const auto near = counting(touch, solids, Vec3(x, 0, -0.008));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_NEAR(near[0].surface.distance, -0.009, 1e-12) << x;
  }
  for (; x > 0.04; x -= 5e-4) {
    const auto near = counting(touch, solids, Vec3(x + 0.002, 0, -0.008));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_GT(near[0].surface.distance, 0) << x;
  }
}

// A floor and a wall that stands beside it, on the same ground; `over`: the floor goes on below.
std::vector<Solid> floor_and_wall(const Mat3& turned, bool over) {
  const double more = over ? 0.02 : 0;
  const Vec3 low(more / 2 - 0.05, 0, -0.01), wall(0.01, 0, over ? 0.02 : 0.01);
  return {{Box{Vec3(0.1 + more, 0.1, 0.02)}, turned_at(turned, turned * low), {}},
          {Box{Vec3(0.02, 0.1, over ? 0.04 : 0.06)}, turned_at(turned, turned * wall), {}}};
}

TEST(SolidTouch, InACornerOfTwoBoxesBothHoldThePoint) {
  Random random(42);
  for (int round = 0; round < 100; ++round) {
    const Mat3 turned = random.rotation();
    const std::vector<Solid> solids = floor_and_wall(turned, round % 2 == 0);
    SolidTouch touch(0, 2);
    const double deep = random.between(1e-4, 5e-3), step = random.between(1e-5, 1e-3);
    for (double z = 0.002; z > -deep; z -= 1e-4)
      counting(touch, solids, turned * Vec3(-0.01, 0, z));
    for (double x = -0.01; x < 0.004; x += step) {
      const auto near = counting(touch, solids, turned * Vec3(x, 0, -deep));
      ASSERT_EQ(near.size(), 2u) << x;
      EXPECT_NEAR(near[0].surface.distance, -deep, 1e-12) << x;
      EXPECT_NEAR(near[1].surface.distance, -x, 3e-6) << x;
      EXPECT_LT((near[0].surface.normal - turned.col(2)).norm(), 1e-9);
      EXPECT_LT((near[1].surface.normal + turned.col(0)).norm(), 1e-9);
    }
  }
}

TEST(SolidTouch, SqueezedBetweenABoxAndAFloorBothHoldThePoint) {
  Random random(44);
  for (int round = 0; round < 100; ++round) {
    const bool box_below = round % 2 == 0;
    const double radius = round % 3 * 0.002, step = random.between(1e-5, 1e-3);
    std::vector<Solid> solids(2);
    solids[0] = {Plane{Vec3::UnitZ()}, Pose::Identity(), {}};
    if (box_below) {
      solids[0] = {Box{Vec3(0.2, 0.2, 0.02)}, turned_at(Mat3::Identity(), Vec3(0, 0, -0.01)), {}};
    }
    SolidTouch touch(radius, 2);
    const Vec3 aside(random.between(-0.012, 0.012), random.between(-0.012, 0.012), 0);
    double bottom = 0.02, z = 0.004;  // the box comes down behind the point
    for (; bottom > -0.003; bottom -= 2 * step, z = std::max(-0.002, z - step)) {
      solids[1] = {
          Box{Vec3::Constant(0.03)}, turned_at(Mat3::Identity(), Vec3(0, 0, bottom + 0.015)), {}};
      const auto near = counting(touch, solids, aside + z * Vec3::UnitZ());
      ASSERT_EQ(near.size(), 2u);
      EXPECT_NEAR(near[0].surface.distance, z, 1e-12);
      EXPECT_NEAR(near[1].surface.distance, bottom - z, 1e-12);
      EXPECT_NEAR(near[0].surface.normal.z(), 1, 1e-12);
      EXPECT_NEAR(near[1].surface.normal.z(), -1, 1e-12);
    }
  }
}

// The free place is nearer to a dome than to the floor, by less than rounding parts things that
// meet; the point itself is in the floor and outside of the dome.
TEST(SolidTouch, WhatIsNotTouchedHidesNothing) {
  constexpr double kRadius = 0.03, kMiddle = 0.01, kDeep = 3.33e-3;
  Pose dome = Pose::Identity();
  dome.translation() = Vec3(0, 0, kMiddle);
  const std::vector<Solid> solids{{Plane{}, Pose::Identity(), {}}, {Sphere{kRadius}, dome, {}}};
  // A place just above the floor that is as far from the dome as `off`.
  for (double off = 1e-7; off < 3e-6; off += 1e-7) {
    const double out = kRadius + off, up = kMiddle - kAbove;
    const Vec3 at(std::sqrt(out * out - up * up), 0, 0);
    SolidTouch touch(0, 2);
    counting(touch, solids, at + Vec3(0, 0, 0.001));
    const auto near = counting(touch, solids, at - kDeep * Vec3::UnitZ());
    ASSERT_FALSE(near.empty()) << off;
    EXPECT_EQ(near[0].solid, 0u) << off;
    EXPECT_NEAR(near[0].surface.distance, -kDeep, 1e-12) << off;
  }
}

// A floor z < 0 and a ramp that rises from it along y; the ramp's edge lies `below` the floor.
std::vector<Solid> floor_and_ramp(const Mat3& turned, double angle, double below, bool plane) {
  const Vec3 size(0.2, 0.06, 0.02);
  const Mat3 up = Eigen::AngleAxisd(angle, Vec3::UnitX()).matrix();
  const Vec3 middle = up * Vec3(0, size.y() / 2, -size.z() / 2) - below * Vec3::UnitZ();
  Solid floor{Plane{turned.col(2)}, Pose::Identity(), {}};
  if (!plane)
    floor = {Box{Vec3(0.2, 0.2, 0.03)}, turned_at(turned, turned * Vec3(0, 0, -0.015)), {}};
  return {floor, {Box{size}, turned_at(turned * up, turned * middle), {}}};
}

// The place nearest to p above the floor and the ramp, both moved out by the radius, in closed
// form.
Vec3 above_floor_and_ramp(const Vec3& p, double angle, double below, double radius) {
  const Vec3 along(0, std::cos(angle), std::sin(angle)), out(0, -std::sin(angle), std::cos(angle));
  const double y = below / std::tan(angle) - radius * std::tan(angle / 2);
  const Vec3 corner(p.x(), y, radius);
  const double way = along.dot(p - corner), over = out.dot(p - corner);
  if (way > 0 && over < 0) return corner + way * along;
  if (p.y() < y && p.z() < radius) return Vec3(p.x(), p.y(), radius);
  return over < 0 ? corner : p;
}

// The tip goes over a floor and up a ramp, pressed in by a few millimetres.
TEST(SolidTouch, FromAFloorToARampThePlaceIsTheNearestFreeOne) {
  Random random(45);
  for (int round = 0; round < 300; ++round) {
    const Mat3 turned = random.rotation();
    const double angle = random.between(0.1, 1.5), below = random.between(0, 5e-4);
    const double radius = round % 3 * 0.002, deep = random.between(1e-4, 5e-3);
    const auto solids = floor_and_ramp(turned, angle, below, round % 2 == 0);
    SolidTouch touch(radius, 2);
    const double step = random.between(1e-6, 1e-4);
    double worst = 0;
    const double z = radius - deep;
    for (double y = -0.005; y < 0.005; y += step) {
      const double down = std::max(z, radius + 0.001 - 2 * (y + 0.005));
      const Vec3 p(0.003, y, down), point = turned * p;
      FreeSpace space;
      for (const auto& near : counting(touch, solids, point)) {
        if (near.surface.distance >= radius) continue;
        const Vec3& n = near.surface.normal;
        space.add(n, n.dot(point) - near.surface.distance + radius);
      }
      Vec3 place;
      FreeSpace::Active by;
      ASSERT_TRUE(space.project(point, place, by));
      const Vec3 right = turned * above_floor_and_ramp(p, angle, below, radius);
      worst = std::max(worst, (place - right).norm());
    }
    // A free place is above its surfaces by two micrometres, and it is late by a part of a step.
    EXPECT_LT(worst, 1e-5 + step) << "round " << round << ", angle " << angle;
  }
}

TEST(SolidTouch, OfTwoHalfSpacesBothCount) {
  const std::vector<Solid> solids{{Plane{Vec3::UnitZ()}, Pose::Identity(), {}},
                                  {Plane{Vec3(0, 0.6, 0.8)}, Pose::Identity(), {}}};
  SolidTouch touch(0.005, 2);
  for (double z = 0.01; z > -0.01; z -= 1e-4) {
    EXPECT_EQ(counting(touch, solids, Vec3(0, 0, z)).size(), 2u);
  }
}

// Level slabs side by side, drawn; the point presses into them and wanders.
TEST(SolidTouch, OfLevelSlabsOneHoldsThePointAndAsDeepAsOneWould) {
  Random random(43);
  for (int round = 0; round < 60; ++round) {
    const Mat3 turned = random.rotation();
    const double high = random.between(0.001, 0.02), radius = round % 3 * 0.002;
    std::vector<Solid> solids;
    double left = -0.05;
    while (left < 0.05) {
      const double wide = random.between(0.005, 0.03);
      const Vec3 middle(left + wide / 2, 0, -high / 2);
      solids.push_back({Box{Vec3(wide, 0.2, high)}, turned_at(turned, turned * middle), {}});
      left += wide;
    }
    SolidTouch touch(radius, solids.size());
    const double deep = random.between(1e-4, 5e-3), step = random.between(1e-5, 1e-3);
    for (double x = -0.04; x < 0.04; x += step) {
      const double z = std::max(radius - deep, radius + 0.002 - 0.3 * (x + 0.04));
      int pushes = 0;
      for (const auto& near : counting(touch, solids, turned * Vec3(x, 0, z))) {
        if (near.surface.distance > radius) continue;
        ++pushes;
        EXPECT_NEAR(near.surface.distance, z, 1e-7);
        // Over a seam to the last nanometres the surface is the edge of one slab.
        EXPECT_LT((near.surface.normal - turned.col(2)).norm(), 5e-3);
      }
      EXPECT_EQ(pushes, z < radius ? 1 : 0) << x;
    }
  }
}

}  // namespace
}  // namespace limpid
