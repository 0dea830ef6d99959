// Bodies on flat faces of every kind: they rest where their weight presses them, stay there, roll
// and bounce as closed forms say.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/support/body_worlds.h"
#include "tests/support/meshes.h"

namespace limpid::test {
namespace {

constexpr double kStiff = 20000, kWeight = 0.05 * 9.81;  // of a contact [N/m]; of the bodies [N]

// Fixed objects with a level face at z = 0.
std::vector<std::pair<const char*, Object>> floors() {
  std::vector<std::pair<const char*, Object>> all;
  all.emplace_back("plane", floor_at(0));
  Object shelf;
  shelf.shape = Box{Vec3(0.8, 0.5, 0.1)};
  shelf.pose = pose_at({0.03, 0.02, -0.05});
  shelf.pose.linear() = turned(0.4, Vec3::UnitZ());
  all.emplace_back("box", shelf);
  Object drum;
  drum.shape = Cylinder{0.4, 0.1};
  drum.pose = pose_at({0.03, 0.02, -0.05});
  all.emplace_back("end of a cylinder", drum);
  all.emplace_back("model", obstacle(sheet(7, 0.8), 1000));
  for (auto& [name, floor] : all) {
    floor.name = "floor";
    floor.material = {2000, 0, 0.6, 0.5};
  }
  return all;
}

Triangles prism(int sides, double radius, double half) {
  Triangles all;
  for (int i = 0; i < sides; ++i) {
    const double turn = 2 * std::numbers::pi * i / sides;
    for (const double z : {-half, half})
      all.vertices.push_back(
          Vec3(radius * std::cos(turn), radius * std::sin(turn), z).cast<float>());
  }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
    all.indices.insert(all.indices.end(), {a, b, a + 1, a + 1, b, b + 1});
    if (i > 0 && i + 1 < n) all.indices.insert(all.indices.end(), {0, b, a, 1, a + 1, b + 1});
  }
  return all;
}

Triangles slab(const Vec3& size) {
  Triangles all = prism(4, std::sqrt(0.5), 0.5);
  const Mat3 eighth = turned(std::numbers::pi / 4, Vec3::UnitZ());
  for (Eigen::Vector3f& v : all.vertices)
    v = size.cwiseProduct(Vec3(eighth * v.cast<double>())).cast<float>();
  return all;
}

struct Thing {
  const char* name;
  Shape shape;
  double height;  // of its centre at rest [m]
  Mat3 turned;
  int points;  // that bear it
};
std::vector<Thing> things() {
  const Mat3 up = turned(0.3, Vec3::UnitZ());
  const Mat3 lying = turned(0.43, Vec3::UnitZ()) * turned(std::numbers::pi / 2, Vec3::UnitX());
  return {{"standing can", Cylinder{0.02, 0.05}, 0.025, up, 4},
          {"lying can", Cylinder{0.02, 0.05}, 0.02, lying, 2},
          {"lying capsule", Capsule{0.02, 0.05}, 0.02, lying, 2},
          {"cube", Box{Vec3(0.04, 0.05, 0.02)}, 0.01, up, 4},
          {"model of a prism", mesh_of(obstacle(prism(24, 0.02, 0.025))), 0.025, up, 4}};
}

Object placed(const Thing& thing, double above) {
  Object o = body("thing", thing.shape, 0.05, {0.0137, 0.0123, thing.height + above}, 0.6);
  o.pose.linear() = thing.turned;
  return o;
}

TEST(FlatContacts, BearAThingByItsWeightOverTheirStiffnessAndKeepIt) {
  for (const auto& [on, floor] : floors()) {
    for (const Thing& thing : things()) {
      SCOPED_TRACE(std::string(thing.name) + " on a " + on);
      Scene scene;
      scene.add(floor);
      scene.add(placed(thing, 0.003));
      BodyWorld world(scene);
      const Pose first = world.pose(0);
      EXPECT_LT(run(world, 1500), 1e-12);
      const Pose last = world.pose(0);
      EXPECT_NEAR(last.translation().z(), thing.height - kWeight / (thing.points * kStiff), 2e-6);
      EXPECT_LT((last.translation() - first.translation()).head<2>().norm(), 1e-5);
      EXPECT_LT((last.linear() - first.linear()).norm(), 3e-4);
      EXPECT_EQ(world.awake(), 0);
    }
  }
}

TEST(FlatContacts, ThrowBackWhatFallsFlatAsItsRestitutionSays) {
  for (const auto& [on, floor] : floors()) {
    for (const Thing& thing : things()) {
      SCOPED_TRACE(std::string(thing.name) + " on a " + on);
      Scene scene;
      scene.add(floor);
      scene.add(placed(thing, 0.05));
      scene.objects.back().body->restitution = 0.8;
      BodyWorld world(scene);
      const double falls = std::sqrt(2 * 0.05 / 9.81);
      double up = 0;
      for (int k = 0; k < static_cast<int>(1.2 * falls / kTick); ++k) {
        run(world, 1);
        up = std::max(up, world.speed(0).z());
      }
      EXPECT_NEAR(up, 0.8 * std::sqrt(2 * 9.81 * 0.05), 0.02);
      EXPECT_LT(world.spin(0).norm(), 0.02);
      EXPECT_LT(world.speed(0).head<2>().norm(), 1e-3);
    }
  }
}

TEST(FlatContacts, LetRodsRollAsTheirInertiaSays) {
  for (const auto& [on, floor] : floors()) {
    for (const bool capsule : {false, true}) {
      SCOPED_TRACE(std::string(capsule ? "capsule" : "cylinder") + " on a " + on);
      const double r = 0.02, l = 0.05, slope = 0.17;
      Scene scene;
      scene.gravity = 9.81 * Vec3(std::sin(slope), 0, -std::cos(slope));
      scene.add(floor);
      Object rod = body("rod", Cylinder{r, l}, 0.05, {-0.1, 0.01, r}, 0.6);
      if (capsule) rod.shape = Capsule{r, l};
      rod.pose.linear() = turned(std::numbers::pi / 2, Vec3::UnitX());
      scene.add(rod);
      BodyWorld world(scene);
      run(world, 200);
      const double v = world.speed(0).x();
      run(world, 200);
      // I / (m r^2): of a capsule by its cylinder and the two halves of a ball.
      const double ball = 4.0 / 3 * r, all = l + ball;
      const double inertia = capsule ? (0.5 * l + 0.4 * ball) / all : 0.5;
      const double a = 9.81 * std::sin(slope) / (1 + inertia);
      EXPECT_NEAR((world.speed(0).x() - v) / 0.2, a, 0.01 * a);
      EXPECT_LT(std::abs(world.center(0).y() - 0.01), 1e-4);
    }
  }
}

// A can that is let go at an angle wobbles on its rim, and comes to rest on its end.
TEST(FlatContacts, StandACanUpThatIsLetGoAtAnAngle) {
  for (const auto& [on, floor] : floors()) {
    for (const double tilt : {0.01, 0.035, 0.1, 0.2}) {
      SCOPED_TRACE(std::string(on) + ", " + std::to_string(tilt));
      Scene scene;
      scene.add(floor);
      Object can = body("can", Cylinder{0.02, 0.05}, 0.05, {0.0137, 0.0123, 0}, 0.6);
      can.pose.linear() = turned(tilt, Vec3(0.9, 0.4, 0));
      can.pose.translation().z() = 0.025 * std::cos(tilt) + 0.02 * std::sin(tilt);
      scene.add(can);
      BodyWorld world(scene);
      EXPECT_LT(run(world, 5000), 1e-12);
      EXPECT_NEAR(world.center(0).z(), 0.025 - kWeight / (4 * kStiff), 2e-6);
      EXPECT_EQ(world.awake(), 0);
    }
  }
}

// Thrown in any pose, a thing ends at rest on the floor, not in it.
TEST(FlatContacts, HoldWhateverFallsOnThem) {
  Random random(2718);
  const Triangles tetrahedron{{{0.02f, 0.013f, -0.01f},
                               {-0.02f, 0.011f, -0.012f},
                               {0.001f, -0.022f, -0.009f},
                               {0.003f, 0.002f, 0.021f}},
                              {0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0}};
  for (int i = 0; i < 60; ++i) {
    const auto all = floors();
    const auto& [on, floor] = all[static_cast<std::size_t>(i) % all.size()];
    const std::array<Shape, 4> shapes{
        Cylinder{random.between(0.006, 0.03), random.between(0.006, 0.08)},
        Capsule{random.between(0.006, 0.03), random.between(0.006, 0.08)},
        mesh_of(obstacle(tetrahedron)), Box{Vec3(0.02, 0.03, 0.05)}};
    const std::size_t kind = static_cast<std::size_t>(i / 4) % shapes.size();
    SCOPED_TRACE(std::to_string(i) + ": shape " + std::to_string(kind) + " on a " + on);
    Scene scene;
    scene.add(floor);
    Object o = body("thing", shapes[kind], random.between(0.02, 0.4), {0.013, -0.012, 0.08}, 0.5);
    o.pose.linear() =
        turned(random.between(-3, 3), Vec3(random.between(-1, 1), random.between(-1, 1), 0.3));
    scene.add(o);
    BodyWorld world(scene);
    EXPECT_LT(run(world, 8000), 1e-9);
    const double deepest = 3 * scene.objects[1].body->mass * 9.81 / kStiff;
    const Pose pose = world.pose(0);
    double lowest = 0;
    if (const auto* rod = std::get_if<Cylinder>(&o.shape)) {
      const double rise = std::min(1.0, std::abs(pose.linear()(2, 2)));
      lowest = pose.translation().z() - rise * rod->length / 2 -
               std::sqrt(1 - rise * rise) * rod->radius;
    } else if (const auto* capsule = std::get_if<Capsule>(&o.shape)) {
      lowest = pose.translation().z() - std::abs(pose.linear()(2, 2)) * capsule->length / 2 -
               capsule->radius;
    } else if (const auto* box = std::get_if<Box>(&o.shape)) {
      lowest = pose.translation().z() - pose.linear().row(2).cwiseAbs().dot(box->size) / 2;
    } else {
      lowest = 1;
      for (const Eigen::Vector3f& v : tetrahedron.vertices) {
        lowest = std::min(lowest, (pose * Vec3(v.cast<double>())).z());
      }
    }
    EXPECT_GT(lowest, -deepest - 1e-5);
    EXPECT_LT(lowest, 1e-4);
    EXPECT_LT(world.speed(0).norm(), 2e-3);
  }
}

// A plank that rocks on a lying cylinder without slipping: w^2 = g (R - h) / (k^2 + h^2), h half of
// its thickness, k its radius of gyration. It never swings higher than it was let go.
TEST(FlatContacts, LetAPlankRockOnARoundSupportAsItsInertiaSays) {
  const double R = 0.05, h = 0.002, length = 0.12, tilt = 0.05;
  const double gyration2 = (length * length + 4 * h * h) / 12;
  const double period = 2 * std::numbers::pi * std::sqrt((gyration2 + h * h) / (9.81 * (R - h)));
  for (const bool ball : {false, true}) {
    SCOPED_TRACE(ball ? "on a ball" : "on a cylinder");
    Scene scene;
    Object support;
    support.name = "support";
    support.shape = ball ? Shape(Sphere{R}) : Shape(Cylinder{R, 0.2});
    support.pose = pose_at({0.01, 0.02, 0.2});
    if (!ball) support.pose.linear() = turned(std::numbers::pi / 2, Vec3::UnitX());
    support.material = {2000, 0, 0.9, 0.9};
    scene.add(support);
    // Rolled by the tilt: the contact is R tilt from the top, and as far from the plank's middle.
    const Vec3 normal(std::sin(tilt), 0, std::cos(tilt)), along(std::cos(tilt), 0, -std::sin(tilt));
    Object plank = body("plank", Box{Vec3(length, 0.03, 2 * h)}, 0.05,
                        Vec3(0.01, 0.02, 0.2) + (R + h) * normal - R * tilt * along, 0.9);
    plank.pose.linear() = turned(tilt, Vec3::UnitY());
    scene.add(plank);
    BodyWorld world(scene);
    const auto slope = [&] { return -world.pose(0).linear()(2, 0); };
    double before = slope(), highest = 0;
    std::vector<double> level;  // times at which it is level
    for (int k = 1; k <= 8000; ++k) {
      run(world, 1);
      const double now = slope();
      if (now * before < 0) level.push_back(k * kTick);
      if (k > 500) highest = std::max(highest, std::abs(now));
      before = now;
    }
    EXPECT_LT(highest, std::sin(tilt) * 1.001);
    EXPECT_GT(highest, 0.5 * std::sin(tilt)) << "it rocks on";
    ASSERT_GT(level.size(), 40u);
    EXPECT_NEAR((level[40] - level[0]) / 20, period, 0.005 * period);
    EXPECT_LT(world.center(0).z(), 0.2 + R + h + 1e-3);
    EXPECT_GT(world.center(0).z(), 0.2 + R + h - 1e-4) << "it does not sink";
  }
}

// A hull stands on its lowest corner, also where another one is as near as points of one place are.
TEST(FlatContacts, BearAHullByTheLowerOfTwoCornersBesideEachOther) {
  const Triangles hull{{{0.02f, 0.013f, 0},
                        {-0.02f, 0.011f, 0},
                        {0.001f, -0.022f, -0.0008f},
                        {0.0012f, -0.0221f, -0.0002f},
                        {0.003f, 0.002f, 0.03f}},
                       {0, 1, 2, 0, 4, 1, 1, 4, 2, 2, 4, 3, 2, 3, 0, 3, 4, 0}};
  for (const auto& [on, floor] : floors()) {
    SCOPED_TRACE(on);
    Scene scene;
    scene.add(floor);
    scene.add(body("hull", mesh_of(obstacle(hull)), 0.05, {0.0137, 0.0123, 0.003}, 0.6));
    BodyWorld world(scene);
    run(world, 3000);
    double lowest = 1;
    for (const Eigen::Vector3f& v : hull.vertices)
      lowest = std::min(lowest, (world.pose(0) * Vec3(v.cast<double>())).z());
    EXPECT_GT(lowest, -kWeight / kStiff - 1e-5);
    EXPECT_LT(lowest, 0);
  }
}

// A prism has more corners than a pair has points; the choice among them stays while it lies still.
TEST(FlatContacts, BearALoadOnAPrismWithoutTrembling) {
  for (const int sides : {6, 8, 10, 12}) {
    SCOPED_TRACE(sides);
    Scene scene;
    scene.add(floor_at(0));
    scene.add(body("prism", mesh_of(obstacle(prism(sides, 0.02, 0.025))), 0.05, {0, 0, 0.026}));
    scene.add(body("load", Box{Vec3(0.03, 0.03, 0.02)}, 1, {0, 0, 0.063}));
    BodyWorld world(scene);
    run(world, 1500);
    const Vec3 before = world.center(0);
    EXPECT_LT(run(world, 2000), 1e-12);
    EXPECT_LT((world.center(0) - before).norm(), 2e-5);
    EXPECT_GT(world.center(0).z(), 0.025 - 1.5 * 1.05 * 9.81 / (4 * kStiff));
  }
}

// Corners of a shape: all others are within them.
std::vector<Vec3> corners_of(const Shape& shape) {
  std::vector<Vec3> corners;
  if (const auto* box = std::get_if<Box>(&shape)) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 side((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      corners.push_back(0.5 * box->size.cwiseProduct(side));
    }
  } else if (const auto* can = std::get_if<Cylinder>(&shape)) {
    for (int i = 0; i < 720; ++i) {
      const double turn = std::numbers::pi * i / 360;
      for (const double end : {-0.5, 0.5})
        corners.emplace_back(can->radius * std::cos(turn), can->radius * std::sin(turn),
                             end * can->length);
    }
  } else {
    const TriangleMesh& mesh = *std::get<Mesh>(shape).triangles;
    for (std::size_t t = 0; t < mesh.triangles(); ++t) {
      for (const Vec3& corner : mesh.corners(t)) corners.push_back(corner + mesh.middle());
    }
  }
  return corners;
}

// How deep two shapes are in each other: the shortest way that parts them, searched for downhill
// from the best of many directions.
double overlap(const Shape& one, const Pose& at, const Shape& two, const Pose& there) {
  std::vector<Vec3> a = corners_of(one), b = corners_of(two);
  for (Vec3& corner : a) corner = at * corner;
  for (Vec3& corner : b) corner = there * corner;
  const auto along = [&](const Vec3& way) {
    double most = -1, least = 1;
    for (const Vec3& corner : a) most = std::max(most, way.dot(corner));
    for (const Vec3& corner : b) least = std::min(least, way.dot(corner));
    return most - least;
  };
  std::vector<std::pair<double, Vec3>> ways;
  for (int i = 0; i < 600; ++i) {
    const double z = 1 - (2 * i + 1) / 600.0, turn = 2.399963 * i, out = std::sqrt(1 - z * z);
    const Vec3 way(out * std::cos(turn), out * std::sin(turn), z);
    ways.emplace_back(along(way), way);
  }
  std::ranges::sort(ways, {}, &std::pair<double, Vec3>::first);
  double least = 1;
  for (std::size_t i = 0; i < 20; ++i) {
    auto [depth, way] = ways[i];
    for (double step = 0.1; step > 1e-7;) {
      bool less = false;
      for (int k = 0; k < 12; ++k) {
        const Vec3 u = way.unitOrthogonal();
        const double turn = std::numbers::pi * k / 6 + static_cast<double>(i);
        const Vec3 other =
            (way + step * (std::cos(turn) * u + std::sin(turn) * way.cross(u))).normalized();
        if (const double now = along(other); now < depth - 1e-12) {
          depth = now;
          way = other;
          less = true;
        }
      }
      if (!less) step /= 2;
    }
    least = std::min(least, depth);
  }
  return least;
}

// A thing falls on another one that lies on the floor. At rest they are no deeper in each other
// than weights press.
TEST(FlatContacts, HoldThingsThatFallOnEachOther) {
  Random random(3141);
  const auto any_shape = [&](int kind, double size) -> Shape {
    const double width = size * random.between(0.3, 1), height = size * random.between(0.3, 1);
    if (kind == 0) return Box{2 * Vec3(width, random.between(0.3, 1) * size, height)};
    if (kind == 1) return Cylinder{width, height};
    return mesh_of(obstacle(prism(static_cast<int>(random.between(3, 13)), width, height / 2)));
  };
  const auto any_turn = [&] {
    return turned(random.between(-3, 3), Vec3(random.between(-1, 1), random.between(-1, 1), 0.3));
  };
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    Scene scene;
    scene.add(floor_at(0));
    const Shape below = any_shape(i % 3, 0.05), above = any_shape(i / 3 % 3, i % 2 ? 0.025 : 0.08);
    scene.add(body("below", below, random.between(0.05, 0.3), {0, 0, 0.12}));
    scene.add(body("above", above, random.between(0.02, 0.2), {0.004, -0.003, 0.4}));
    for (Object& object : std::span(scene.objects).subspan(1)) object.pose.linear() = any_turn();
    BodyWorld world(scene);
    EXPECT_LT(run(world, 4000), 1e-9);
    const double weight = 9.81 * (scene.objects[1].body->mass + scene.objects[2].body->mass);
    EXPECT_LT(overlap(below, world.pose(0), above, world.pose(1)), 2 * weight / kStiff + 2e-5);
  }
}

// A model that lies across what is narrower than itself stays on it: its own corners are beyond.
TEST(FlatContacts, HoldAModelAcrossANarrowSupport) {
  // No face is across an axis of the file.
  Triangles triangles = slab(Vec3(0.12, 0.03, 0.008));
  const Mat3 askew = turned(0.83, Vec3(0.3, -0.5, 0.7));
  for (Eigen::Vector3f& v : triangles.vertices) v = (askew * v.cast<double>()).cast<float>();
  const Object plank = obstacle(triangles);
  Object support;
  support.name = "support";
  support.material = {2000, 0, 0.6, 0.6};
  support.pose = pose_at({0.01, 0.02, 0});
  const auto with = [&](const Shape& shape, const Mat3& turn) {
    Object one = support;
    one.shape = shape;
    one.pose.linear() = turn;
    return one;
  };
  const Mat3 lying = turned(std::numbers::pi / 2, Vec3::UnitX());
  const std::array<std::tuple<const char*, Object, double, int>, 4> all{{
      {"narrow box", with(Box{Vec3(0.02, 0.2, 0.1)}, Mat3::Identity()), 0.05, 4},
      {"box, askew", with(Box{Vec3(0.02, 0.2, 0.1)}, turned(0.5, Vec3::UnitZ())), 0.05, 4},
      {"cylinder's side", with(Cylinder{0.02, 0.2}, lying), 0.02, 2},
      {"cylinder's end", with(Cylinder{0.012, 0.1}, Mat3::Identity()), 0.05, 4},
  }};
  for (const auto& [name, below, height, points] : all) {
    SCOPED_TRACE(name);
    Scene scene;
    scene.add(below);
    scene.add(body("plank", mesh_of(plank), 0.05, {0.01, 0.02, height + 0.006}, 0.6));
    scene.objects.back().pose.linear() = askew.transpose();
    BodyWorld world(scene);
    EXPECT_LT(run(world, 4000), 1e-9);
    EXPECT_NEAR(world.center(0).z(), height + 0.004 - kWeight / (points * kStiff), 3e-6);
    EXPECT_LT((world.center(0) - Vec3(0.01, 0.02, world.center(0).z())).norm(), 2e-4);
    EXPECT_LT(std::abs((world.pose(0).linear() * askew)(2, 0)), 2e-3);
  }
}

// A capsule in the groove of two others, turned a little from them, lies where all three touch.
TEST(FlatContacts, HoldACapsuleInTheGrooveOfTwo) {
  for (const double askew : {0.0, 0.02, 0.2}) {
    SCOPED_TRACE(askew);
    const double r = 0.02, apart = 0.05;
    Scene scene;
    for (const double side : {-1.0, 1.0}) {
      Object log;
      log.name = side < 0 ? "left" : "right";
      log.shape = Capsule{r, 0.2};
      log.pose = pose_at({0, side * apart / 2, 0});
      log.pose.linear() = turned(std::numbers::pi / 2, Vec3::UnitY());
      log.material = {2000, 0, 0.6, 0.6};
      scene.add(log);
    }
    const double height = std::sqrt(4 * r * r - apart * apart / 4);
    Object top = body("top", Capsule{r, 0.1}, 0.05, {0.01, 0, height + 0.004}, 0.6);
    top.pose.linear() = turned(askew, Vec3::UnitZ()) * turned(std::numbers::pi / 2, Vec3::UnitY());
    scene.add(top);
    BodyWorld world(scene);
    EXPECT_LT(run(world, 3000), 1e-12);
    EXPECT_NEAR(world.center(0).z(), height, askew > 0.1 ? 4e-3 : 3e-4);
    EXPECT_GT(world.center(0).z(), height - 1e-4);
    EXPECT_LT(world.speed(0).norm(), 1e-3);
  }
}

}  // namespace
}  // namespace limpid::test
