// Properties of a ball on any mesh and path: the force is finite and never jumps, the ball never
// falls through, and no force remains when it has left.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/touch/mesh_touch.h"
#include "tests/support/meshes.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using test::Triangles;

using test::T;
constexpr double kSlip = 0.1 * T;  // of the anchor beyond the centre's motion in a tick [m]

// A ball, its force over the stiffness, and checks of it in every tick.
class Watched {
 public:
  Watched(const Object& mesh, double radius, const Vec3& c)
      : mesh_(mesh), touch_(mesh, radius), c_(c) {
    touch_.place(c);
    pull_ = find_pull();
  }

  void follow(const Vec3& c) {
    const double moved = (c - c_).norm();
    const Vec3 before = pull_;
    c_ = c;
    touch_.follow(c, T);
    pull_ = find_pull();
    ASSERT_TRUE(pull_.allFinite());
    // The ball rests on the surface to a hundred thousandth of its size: twice that is no jump.
    const double rounding = 4e-5 * touch_.radius() + 1e-5 * size();
    ASSERT_LE((pull_ - before).norm(), 3 * moved + kSlip + rounding);
    held += touch_.held() ? 1 : 0;
    touched += pull_.norm() > 0 ? 1 : 0;
    deepest = std::max(deepest, pull_.norm());
    if (++ticks_ % 4 == 0 && test::mesh_of(mesh_).triangles->health().closed() && !touch_.held()) {
      ASSERT_FALSE(test::mesh_of(mesh_).triangles->behind(local(touch_.anchor())));
    }
  }

  const Vec3& center() const { return c_; }
  const Vec3& pull() const { return pull_; }
  const MeshTouch& touch() const { return touch_; }
  double size() const {
    return test::mesh_of(mesh_).scale * test::mesh_of(mesh_).triangles->radius();
  }
  Vec3 local(const Vec3& world) const {
    return mesh_.pose.inverse() * world / test::mesh_of(mesh_).scale -
           test::mesh_of(mesh_).triangles->middle();
  }

  int held = 0, touched = 0;
  double deepest = 0;

 private:
  Vec3 find_pull() const {
    if (touch_.held()) return touch_.anchor() - c_;
    if (!touch_.near()) return Vec3::Zero();
    Vec3 x;
    FreeSpace::Active active;
    EXPECT_TRUE(touch_.space().project(c_, x, active));
    return x - c_;
  }

  Object mesh_;
  MeshTouch touch_;
  Vec3 c_, pull_;
  int ticks_ = 0;
};

// Half a sheet folded back on itself: both halves in the same place.
Triangles folded() {
  return test::sheet(16, 1).mapped([](const Vec3& p) { return Vec3(std::abs(p.x()), p.y(), 0); });
}

// A ridge of slivers, a hundred thousand times longer than high.
Triangles slivers() {
  return test::grid(400, 2).mapped([](const Vec3& p) {
    const double x = p.x() < 0.5 ? 2e-5 * p.x() - 0.5 : p.x() - 0.5;
    return Vec3(x, p.y() - 0.5, 0.1 * std::cos(7 * x) * std::cos(3 * p.y()));
  });
}

Triangles shape(const std::string& name) {
  if (name == "bumpy") return test::bumpy_body(3, 0.4);
  if (name == "fine") return test::bumpy_body(6, 0.3);
  if (name == "torus") return test::torus(40, 20, 0.7, 0.3);
  if (name == "box") return test::box(Vec3(1.2, 0.7, 0.3));
  if (name == "plate") return test::box(Vec3(1.2, 1.2, 1e-3), 6);
  if (name == "field") {
    return test::height_field(40, 2, [](double x, double y) {
      return 0.15 * std::sin(9 * x) * std::cos(8 * y) + 0.05 * std::sin(40 * x);
    });
  }
  if (name == "sheet") return test::sheet(3, 2);
  if (name == "folded") return folded();
  if (name == "slivers") return slivers();
  Random random(331);
  return test::soup(60, 0.7, random);  // "soup"
}

constexpr const char* kTouchedShapes[] = {"bumpy", "fine",  "torus",  "box",     "plate",
                                          "field", "sheet", "folded", "slivers", "soup"};
constexpr double kSizes[] = {1e-3, 0.05, 10.0};  // [m]
constexpr double kRadii[] = {0.0, 0.02, 0.5};    // relative to the size

class AnyMesh : public testing::TestWithParam<const char*> {
 protected:
  // Runs `path(obstacle, radius, random)` at every size; it returns its number of ticks in contact.
  template <class Path>
  void at_every_size(Path&& path) {
    const auto mesh = shape(GetParam()).mesh();
    Random random(332);
    int touched = 0;
    for (const double size : kSizes) {
      for (const double radius : kRadii) {
        Object obstacle{.shape = Mesh{.scale = size, .triangles = mesh}};
        obstacle.pose.linear() = random.rotation();
        obstacle.pose.translation() = random.point(0.3);
        SCOPED_TRACE(testing::Message() << "size " << size << ", radius " << radius * size);
        touched += path(obstacle, radius * size, random);
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_GT(touched, 1000);
  }
};
INSTANTIATE_TEST_SUITE_P(Shapes, AnyMesh, testing::ValuesIn(kTouchedShapes),
                         [](const auto& name) { return std::string(name.param); });

// A start in front of the surface.
Vec3 start(const Object& mesh, double radius, double most_apart, Random& random) {
  const Vec3 far = 2 * test::mesh_of(mesh).triangles->radius() * random.direction();
  MeshPoint near;
  EXPECT_TRUE(test::mesh_of(mesh).triangles->nearest(far, 1e9, MeshPoint::kNone, near));
  const double gap =
      (radius + std::min(0.2 * test::mesh_of(mesh).scale, most_apart)) / test::mesh_of(mesh).scale;
  return mesh.pose *
         (test::mesh_of(mesh).scale * (near.point + test::mesh_of(mesh).triangles->middle() +
                                       gap * (far - near.point).normalized()));
}

TEST_P(AnyMesh, IsNeverFallenThroughOnASmoothPathThroughIt) {
  at_every_size([](const Object& mesh, double radius, Random& random) {
    const double size = test::mesh_of(mesh).scale;
    const double step = std::min(1.0, 4 * size) * T;  // at most 1 m/s
    Watched ball(mesh, radius, start(mesh, radius, 0.05, random));
    const Vec3 inwards = (mesh.pose.translation() - ball.center()).normalized();
    const double reach = std::min(size, 0.3);
    const Vec3 home = ball.center() + reach * inwards;
    Vec3 goal = home;
    for (int k = 0; k < 2000; ++k) {
      if (k % 200 == 199) goal = home + reach * random.point(1);
      const Vec3 way = goal - ball.center();
      const double length = std::min(step, 0.02 * way.norm());
      ball.follow(ball.center() + length * way.normalized());
      if (testing::Test::HasFatalFailure()) return 0;
    }
    return ball.touched;
  });
}

TEST_P(AnyMesh, IsNeverFallenThroughOnARandomWalk) {
  at_every_size([](const Object& mesh, double radius, Random& random) {
    const double size = test::mesh_of(mesh).scale;
    Watched ball(mesh, radius, start(mesh, radius, 0.001, random));
    for (int k = 0; k < 2000; ++k) {
      const Vec3 home = (mesh.pose.translation() - ball.center()) / size;
      const double step = std::min(1.0, 20 * size) * T * std::pow(10, random.between(-3, 0));
      ball.follow(ball.center() + step * (0.9 * random.direction() + 0.1 * home));
      if (testing::Test::HasFatalFailure()) return 0;
    }
    return ball.touched;
  });
}

TEST_P(AnyMesh, LeavesNothingBehindOnceItHasBeenLeft) {
  at_every_size([](const Object& mesh, double radius, Random& random) {
    const double size = test::mesh_of(mesh).scale;
    int touched = 0;
    for (int round = 0; round < 5; ++round) {
      // Straight in, and out the same way.
      const Vec3 out = mesh.pose.linear() * random.direction();
      const Vec3 outside = mesh.pose.translation() + (2 * size + radius) * out;
      Watched ball(mesh, radius, outside);
      const double depth = random.between(0.3, 2.2) * size;
      const int ticks = std::max(300, static_cast<int>(depth / (1.0 * T)));
      for (int k = 0; k <= 2 * ticks; ++k) {
        const double part = 1 - std::abs(k - ticks) / static_cast<double>(ticks);
        ball.follow(outside - part * depth * out);
        if (testing::Test::HasFatalFailure()) return 0;
      }
      // The anchor follows at 0.1 m/s at least.
      const double rest = ball.pull().norm();
      const int wait = 2 + static_cast<int>(rest / kSlip);
      for (int k = 0; k < wait; ++k) ball.follow(outside);
      EXPECT_EQ(ball.pull(), Vec3::Zero());
      EXPECT_FALSE(ball.touch().held());
      EXPECT_TRUE(ball.touch().recoverable());
      touched += ball.touched;
    }
    return touched;
  });
}

// Presses straight against an open sheet and goes back: the force is always towards the side of
// origin.
void press_a_sheet(const Triangles& sheet, double highest, double depth, unsigned seed) {
  Random random(seed);
  for (const double size : kSizes) {
    for (const double radius : {0.0, 0.01, 0.1}) {
      Object mesh = test::obstacle(sheet);
      test::mesh_of(mesh).scale = size;
      mesh.pose.linear() = random.rotation();
      mesh.pose.translation() = random.point(0.3);
      for (const double side : {1.0, -1.0}) {
        const Vec3 out = mesh.pose.linear() * (side * Vec3::UnitZ());
        const Vec3 foot = size * Vec3(random.between(0.1, 0.4), random.between(-0.3, 0.3), 0);
        const double apart = std::min(0.2 * size, 0.05), deep = std::min(depth * size, 0.2);
        const Vec3 outside =
            mesh.pose * (foot + side * Vec3(0, 0, highest * size + radius * size + apart));
        Watched ball(mesh, radius * size, outside);
        const int ticks = 500;
        for (int k = 0; k <= 2 * ticks; ++k) {
          const double part = 1 - std::abs(k - ticks) / static_cast<double>(ticks);
          ball.follow(outside - part * (apart + deep) * out);
          if (testing::Test::HasFatalFailure()) return;
          ASSERT_GE(ball.pull().dot(out), -1e-12 * size);
        }
        EXPECT_EQ(ball.pull(), Vec3::Zero());
        EXPECT_GT(side * (mesh.pose.inverse() * ball.touch().anchor()).z(), 0);
      }
    }
  }
}

TEST(AnOpenSheet, PushesToTheSideItWasTouchedFrom) {
  press_a_sheet(test::sheet(9, 1), 0, 0.5, 333);
}
TEST(AnOpenSheet, PushesToTheSideItWasTouchedFromWhenFolded) {
  press_a_sheet(folded(), 0, 0.5, 334);
}
TEST(AnOpenSheet, PushesToTheSideItWasTouchedFromWhenWavy) {
  press_a_sheet(
      test::height_field(
          50, 1, [](double x, double y) { return 0.03 * std::sin(20 * x) * std::sin(20 * y); }),
      0.03, 0.1, 335);
}

TEST(ABall, PlacedInsideOfAClosedBodyComesOutAtTheNearestPlace) {
  const Object cube = test::obstacle(test::box(Vec3(0.1, 0.1, 0.1)));
  MeshTouch touch(cube, 0.002);
  const Vec3 c(0.01, -0.02, 0.045);
  touch.place(c);
  EXPECT_LT((touch.anchor() - c - Vec3(0, 0, 0.007)).norm(), 1e-7);
  EXPECT_TRUE(touch.recoverable());
}

TEST(ABall, PlacedBehindASheetStaysThere) {
  const Object sheet = test::obstacle(test::sheet(5, 0.1));
  MeshTouch touch(sheet, 0.002);
  const Vec3 c(0.01, -0.02, -0.0015);
  touch.place(c);
  EXPECT_LT((touch.anchor() - c - Vec3(0, 0, -0.0005)).norm(), 1e-7);
}

TEST(ABall, PlacedAnewForgetsWhatWasNoPlace) {
  const Object cube = test::obstacle(test::box(Vec3(0.1, 0.1, 0.1)));
  MeshTouch touch(cube, 0.002);
  const Vec3 c(0.01, -0.02, 0.051), nowhere = Vec3::Constant(std::nan(""));
  touch.place(c);
  for (int k = 0; k < 3; ++k) touch.follow(nowhere, T);
  touch.place(nowhere);
  touch.follow(nowhere, T);
  touch.place(c);
  EXPECT_LT((touch.anchor() - c - Vec3(0, 0, 0.001)).norm(), 1e-7);
  EXPECT_FALSE(touch.held());
}

}  // namespace
}  // namespace limpid
