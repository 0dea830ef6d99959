// The force of grooves and corners over a tick against the work from their potential.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "core/touch/contact_solve.h"
#include "core/touch/wall_force.h"
#include "tests/support/meshes.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;

using test::T;
constexpr double kRadius = 0.005;
constexpr double kParts = 32;  // segments of the way in which planes come or go

// A surface of flat faces around the origin, open upwards: the room above is convex. Its rays are
// the directions that leave along the surface.
struct Pit {
  test::Triangles faces;
  std::vector<Vec3> rays;
};

// Two faces along x that rise by this angle.
Pit groove(double rise) {
  const double c = std::cos(rise), s = std::sin(rise);
  Pit pit;
  pit.rays = {Vec3::UnitX(), -Vec3::UnitX(), Vec3(0, c, s), Vec3(0, -c, s)};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {0.0, 1.0, -1.0}) {
      pit.faces.vertices.push_back(Vec3(x, y * c, std::abs(y) * s).cast<float>());
    }
  }
  pit.faces.add(0, 3, 4), pit.faces.add(0, 4, 1);
  pit.faces.add(0, 2, 5), pit.faces.add(0, 5, 3);
  return pit;
}

// Three faces between rays that rise by these angles.
Pit corner(Random& random) {
  Pit pit;
  pit.faces.vertices.emplace_back(0, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.1 * i + random.between(-0.3, 0.3), rise = random.between(0.1, 1);
    pit.rays.emplace_back(std::cos(turn) * std::cos(rise), std::sin(turn) * std::cos(rise),
                          std::sin(rise));
    pit.faces.vertices.push_back(pit.rays.back().cast<float>());
  }
  pit.faces.add(0, 1, 2), pit.faces.add(0, 2, 3), pit.faces.add(0, 3, 1);
  return pit;
}

// A ball that has come from above to c.
MeshTouch touch_at(const Pit& pit, const Vec3& c) {
  MeshTouch touch(test::obstacle(pit.faces), kRadius);
  const Vec3 from = c + Vec3(0, 0, 0.1);
  touch.place(from);
  for (int i = 1; i <= 50; ++i) touch.follow(from + i / 50.0 * (c - from), T);
  touch.follow(c, T);
  return touch;
}

struct Held {
  Vec3 pull;
  FreeSpace::Active by;
};
Held held(const MeshTouch& touch, const Vec3& c) {
  Held h;
  Vec3 x;
  EXPECT_TRUE(touch.space().project(c, x, h.by));
  h.pull = x - c;
  return h;
}

RoomTick some_tick(Random& random, const Vec3& c) {
  RoomTick t{};
  t.K = std::pow(10, random.between(1.5, 4.3));
  t.T = T;
  t.center = c;
  t.a = std::pow(10, random.between(-5, -2.5)) * random.direction();
  // A force of the spring reduces its own pull by up to twice that pull.
  t.W = std::pow(10, random.between(-2, 0.3)) / t.K * random.positive_definite(3, 0.05, 1);
  return t;
}

struct Case {
  double given;      // by the spring, beyond its potential's loss [J]
  double bound;      // that the subdivision allows [J]
  double size;       // of the terms [J]
  bool same_planes;  // during the whole tick
};
Case balance(const MeshTouch& touch, const RoomTick& t, const Vec3& F) {
  const Vec3 D = t.a + t.W * F;
  const Held before = held(touch, t.center), after = held(touch, t.center + D);
  const double stored = 0.5 * t.K * (after.pull.squaredNorm() - before.pull.squaredNorm());
  // In a part where the planes change, the pull is not linear. The pull moves no further than the
  // centre, so its mean there is wrong by at most a quarter of the part's length. No set of planes
  // holds twice along a line: with n planes at most 2^n - 1 parts are affected.
  const double parts = std::pow(2, touch.space().count()) - 1;
  const bool same = before.by == after.by;
  const double length = D.norm() / kParts;
  const double way = t.a.norm() + (t.W * F).norm() + before.pull.norm();
  return {F.dot(D) + stored, same ? 0 : parts * t.K * length * length / 4,
          F.norm() * way + t.K * way * way, same};
}

TEST(RoomForce, OfGroovesAndCornersDoesTheWorkThatTheirPotentialLoses) {
  Random random(81);
  int same = 0, changed = 0;
  std::array<int, 4> by{};
  for (int round = 0; round < 20000; ++round) {
    const Pit pit = round % 2 == 0 ? groove(random.between(0.05, 1.4)) : corner(random);
    const Vec3 c = random.between(-1, 1) * kRadius * Vec3::UnitZ() + 1e-3 * random.point(1) +
                   Vec3(0, 0, 0.5 * kRadius);
    const MeshTouch touch = touch_at(pit, c);
    if (touch.held() || touch.space().count() == 0) continue;
    const RoomTick t = some_tick(random, c);
    Vec3 F = Vec3::Zero();
    room_force(touch, t, F);
    const Case b = balance(touch, t, F);
    ASSERT_LE(std::abs(b.given), b.bound + 1e-12 * b.size) << round;
    for (const Vec3& ray : pit.rays) ASSERT_GE(F.dot(ray), -1e-7 * F.norm()) << "it pulls";
    if (F.isZero(0)) continue;
    (b.same_planes ? same : changed) += 1;
    ++by[static_cast<std::size_t>(held(touch, c).by.count)];
  }
  EXPECT_GT(same, 2000);
  EXPECT_GT(changed, 1000);
  EXPECT_GT(by[1], 200);
  EXPECT_GT(by[2], 200);
  EXPECT_GT(by[3], 200);
}

TEST(RoomForce, IsTheSameWhereverItsSearchStarts) {
  Random random(82);
  for (int round = 0; round < 2000; ++round) {
    const Pit pit = round % 2 == 0 ? groove(random.between(0.05, 1.4)) : corner(random);
    const Vec3 c = random.between(-1, 0.5) * kRadius * Vec3::UnitZ();
    const MeshTouch touch = touch_at(pit, c);
    if (touch.held()) continue;
    const RoomTick t = some_tick(random, c);
    Vec3 F = Vec3::Zero(), again = random.point(10);
    room_force(touch, t, F);
    room_force(touch, t, again);
    ASSERT_LT((F - again).norm(), 1e-8 * (1e-3 + F.norm())) << round;
  }
}

TEST(RoomForce, OfADampedRoomNeverGivesAndNeverPulls) {
  Random random(83);
  int pushed = 0;
  for (int round = 0; round < 10000; ++round) {
    const Pit pit = round % 2 == 0 ? groove(random.between(0.05, 1.4)) : corner(random);
    const Vec3 c = random.between(-1, 1) * kRadius * Vec3::UnitZ();
    const MeshTouch touch = touch_at(pit, c);
    if (touch.held() || touch.space().count() == 0) continue;
    RoomTick t = some_tick(random, c);
    t.B = random.between(0, 1) * t.K * T;
    Vec3 F = Vec3::Zero();
    room_force(touch, t, F);
    const Case b = balance(touch, t, F);
    ASSERT_LE(b.given, b.bound + 1e-12 * b.size) << round;
    if (F.isZero(0)) continue;
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < 100; ++i) {
      mean += held(touch, c + (i + 0.5) / 100 * (t.a + t.W * F)).pull / 100;
    }
    ASSERT_GT(F.dot(mean), -1e-3 * F.norm() * mean.norm()) << "it pulls";
    ++pushed;
  }
  EXPECT_GT(pushed, 2000);
}

TEST(RoomForce, OfOnePlaneIsAWalls) {
  Random random(84);
  MeshTouch touch(test::obstacle(test::sheet(1, 2)), kRadius);
  int kept = 0, changed = 0;
  for (int round = 0; round < 20000; ++round) {
    const Vec3 c(random.between(-0.1, 0.1), random.between(-0.1, 0.1),
                 kRadius * random.between(0, 1.1));
    touch.place(c + Vec3(0, 0, 0.1));
    touch.follow(c + Vec3(0, 0, 0.001), T);
    touch.follow(c, T);
    RoomTick t = some_tick(random, c);
    const bool damped = round % 2 == 1;
    if (damped) t.B = random.between(0, 0.3) / t.W(2, 2) * T;
    if (touch.space().count() != 1) continue;
    Vec3 F = Vec3::Zero();
    room_force(touch, t, F);
    const double d = kRadius - c.z();
    const double wanted = wall_force({t.K, t.B, T, d, -t.a.z(), t.W(2, 2)});
    const double end = d - t.a.z() - t.W(2, 2) * wanted;
    ASSERT_LT(F.head<2>().norm(), 1e-12 * (1 + F.norm()));
    if (d > 0 && end > 0) {
      ++kept;
      ASSERT_NEAR(F.z(), wanted, 1e-9 * (1e-3 + wanted)) << round;
    } else {
      // Bound: in the part where the contact is made or breaks, a quarter of the spring's force and
      // half of the damper's.
      if (wanted > 0) ++changed;
      const double way = std::abs(end - d), part = way / kParts;
      const double bound = t.K * part / 4 + t.B / T * part;
      ASSERT_NEAR(F.z(), wanted, bound + 1e-9) << round << " damped " << damped;
    }
  }
  EXPECT_GT(kept, 2000);
  EXPECT_GT(changed, 500);
}

// Slope of the force over the motion by differences to both sides.
Mat3 by_differences(const MeshTouch& touch, RoomTick t) {
  const Vec3 way = t.a;
  const double step = 1e-4 * way.norm();
  Mat3 slope, unused;
  for (int i = 0; i < 3; ++i) {
    t.a = way + step * Vec3::Unit(i);
    const Vec3 there = room_push(touch, t, Slope::quick, unused);
    t.a = way - step * Vec3::Unit(i);
    slope.col(i) = (there - room_push(touch, t, Slope::quick, unused)) / (2 * step);
  }
  return slope;
}

// The damper's directions change with the way where planes come or go along it, or share it.
TEST(RoomForce, HasTheSlopeOfItsDifferencesWhereverPlanesHold) {
  Random random(31);
  int changing = 0, wrong = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pit pit = i % 2 == 0 ? groove(random.between(0.2, 1)) : corner(random);
    const Vec3 c = Vec3(0, 0, random.between(0.5, 1) * kRadius) + random.point(0.3 * kRadius);
    const MeshTouch touch = touch_at(pit, c);
    RoomTick t = some_tick(random, c);
    t.W.setZero();
    t.B = random.between(0.1, 1) * t.K * T;
    Mat3 whole, quick;
    const Vec3 F = room_push(touch, t, Slope::whole, whole);
    room_push(touch, t, Slope::quick, quick);
    if (F.norm() < 1e-3) continue;
    const Mat3 right = by_differences(touch, t);
    wrong += (whole - right).norm() > 0.05 * right.norm() ? 1 : 0;
    changing += (quick - right).norm() > 0.1 * right.norm() ? 1 : 0;
  }
  EXPECT_LE(wrong, 5);  // a difference goes over where a part of the way ends
  EXPECT_GT(changing, 20);
}

TEST(RoomForce, DampsAlongAGroovesFacesAndNotAcrossItsCrease) {
  // Two faces that rise by an angle share the depth h beneath the crease: each has h cos(angle),
  // and 1/(2 cos^2(angle)) of that is its own. So they damp up and down as one wall and sideways by
  // tan^2(angle); at right angles they are two walls.
  for (const double rise : {0.02, 0.3, 0.7, std::numbers::pi / 4}) {
    const Vec3 c(0, 0, 0.3 * kRadius);
    const MeshTouch touch = touch_at(groove(rise), c);
    ASSERT_EQ(held(touch, c).by.count, 2);
    const double way = 1e-6, B = 2;
    for (const Vec3& along : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      RoomTick t{600, 0, T, c, way * along, Mat3::Zero()};
      Vec3 spring = Vec3::Zero(), both = Vec3::Zero();
      room_force(touch, t, spring);
      t.B = B;
      room_force(touch, t, both);
      const double slope = std::tan(rise);
      const double share = along.x() > 0 ? 0 : along.y() > 0 ? slope * slope : 1;
      ASSERT_LT((both - spring + B * way / T * share * along).norm(), 1e-3 * B * way / T) << rise;
    }
  }
}

TEST(RoomForce, OfAnAnchorIsALinearSpring) {
  // The ball is pressed deep beneath a sheet and out over its edge: it hangs on an anchor that
  // follows.
  MeshTouch touch(test::obstacle(test::sheet(4, 0.2)), kRadius);
  Vec3 c(0.09, 0.01, 0.02);
  touch.place(c);
  for (int i = 0; i < 400; ++i) touch.follow(c -= Vec3(0, 0, 1e-4), T);
  for (int i = 0; i < 200 && !touch.held(); ++i) touch.follow(c += Vec3(2e-4, 0, 0), T);
  ASSERT_TRUE(touch.held());
  Random random(85);
  int pushed = 0;
  for (int round = 0; round < 1000; ++round) {
    RoomTick t = some_tick(random, c);
    t.B = random.between(0, 1) * t.K * T * 0.3;
    const double slope = t.K / 2 + t.B / T;
    const Vec3 way = touch.anchor() - c;
    const Mat3 A = Mat3::Identity() + slope * t.W;
    const Vec3 right = t.K * way - slope * t.a;
    const Vec3 wanted = A.inverse() * right;
    const Vec3 pull = way - 0.5 * (t.a + t.W * wanted);
    Vec3 F = Vec3::Zero();
    room_force(touch, t, F);
    if (wanted.dot(pull) <= 0) {
      ASSERT_EQ(F, Vec3::Zero());
      continue;
    }
    ++pushed;
    ASSERT_LT((F - wanted).norm(), 1e-9 * wanted.norm());
  }
  EXPECT_GT(pushed, 300);
}

}  // namespace
}  // namespace limpid
