// Masses and inertias against formulas of solids, and against sums over many small cubes.
#include "core/touch/mass_properties.h"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "tests/support/meshes.h"

namespace limpid {
namespace {

constexpr double kPi = std::numbers::pi;

Object body(Shape shape, double mass = 0.3) {
  Object out{.name = "it", .shape = std::move(shape), .body = Body{}};
  out.body->mass = mass;
  return out;
}

void expect_near(const Mat3& a, const Mat3& b, double within) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), within) << a << "\n is not\n" << b;
}

void expect_inertia(const Object& object, const Vec3& principal) {
  const MassProperties found = mass_properties(object);
  EXPECT_EQ(found.mass, 0.3);
  EXPECT_LT(found.center.norm(), 1e-15);
  expect_near(found.inertia, principal.asDiagonal(), 1e-15);
}

TEST(MassProperties, AreThoseOfTheSolidsInBooks) {
  expect_inertia(body(Sphere{0.02}), Vec3::Constant(0.4 * 0.3 * 0.02 * 0.02));
  const Vec3 s(0.03, 0.05, 0.02);
  expect_inertia(body(Box{s}),
                 0.3 / 12 *
                     Vec3(s.y() * s.y() + s.z() * s.z(), s.x() * s.x() + s.z() * s.z(),
                          s.x() * s.x() + s.y() * s.y()));
  const double r = 0.02, l = 0.05;
  const double across = 0.3 * (3 * r * r + l * l) / 12;
  expect_inertia(body(Cylinder{r, l}), {across, across, 0.3 * r * r / 2});
}

// Density times volume is the mass to round-off only.
TEST(MassProperties, HaveTheBodysMassToTheLastBit) {
  for (int k = 1; k <= 200; ++k) {
    const double mass = 0.0137 * k, radius = 0.001 + 0.00037 * k;
    EXPECT_EQ(mass_properties(body(Sphere{radius}, mass)).mass, mass);
    EXPECT_EQ(mass_properties(body(Cylinder{radius, 3 * radius}, mass)).mass, mass);
  }
}

TEST(MassProperties, VolumesAreThoseOfTheSolidsInBooks) {
  const double r = 0.02, l = 0.05;
  EXPECT_NEAR(volume(body(Sphere{r})), 4 * kPi / 3 * r * r * r, 1e-18);
  EXPECT_NEAR(volume(body(Box{Vec3(0.1, 0.2, 0.3)})), 0.006, 1e-16);
  EXPECT_NEAR(volume(body(Cylinder{r, l})), kPi * r * r * l, 1e-18);
  EXPECT_NEAR(volume(body(Capsule{r, l})), kPi * r * r * (l + 4 * r / 3), 1e-18);
  EXPECT_EQ(volume(body(Plane{})), 0);
  EXPECT_EQ(volume(body(JointStop{})), 0);
}

// A capsule has no formula in most books: a sum over small cubes, whose own inertia counts.
TEST(MassProperties, OfACapsuleAreTheSumOverItsPieces) {
  const Capsule capsule{0.02, 0.05};
  constexpr int kCells = 160;
  const double edge = 0.09 / kCells;
  double count = 0;
  Vec3 squares = Vec3::Zero();
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      for (int k = 0; k < kCells; ++k) {
        const Vec3 p = edge * (Vec3(i, j, k) + Vec3::Constant(0.5)) - Vec3::Constant(0.045);
        const double beyond = std::max(0.0, std::abs(p.z()) - capsule.length / 2);
        if (p.x() * p.x() + p.y() * p.y() + beyond * beyond > capsule.radius * capsule.radius) {
          continue;
        }
        ++count;
        squares += p.cwiseProduct(p);
      }
    }
  }
  const double expected = count * edge * edge * edge;
  EXPECT_NEAR(volume(body(capsule)), expected, 0.002 * expected);
  const MassProperties found = mass_properties(body(capsule));
  squares *= 0.3 / count;
  const Vec3 sum(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y());
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.inertia(i, i), sum[i], 0.003 * sum[i]) << i;
  }
}

Pose some_pose(std::uint32_t seed) {
  test::Random random(seed);
  Pose pose = Pose::Identity();
  pose.linear() = random.rotation();
  pose.translation() = random.point(0.05);
  return pose;
}

// Two halves together are the whole, at any pose of the whole in its frame.
TEST(MassProperties, OfPartsAddUp) {
  const Pose at = some_pose(5);
  Object halves = body(Sphere{1e-9});
  for (const double side : {-0.25, 0.25}) {
    const Pose pose = at * pose_at(Vec3(side * 0.06, 0, 0));
    halves.parts.push_back({pose, Box{Vec3(0.03, 0.02, 0.01)}});
  }
  const MassProperties found = mass_properties(halves);
  const Mat3 whole = mass_properties(body(Box{Vec3(0.06, 0.02, 0.01)})).inertia;
  EXPECT_LT((found.center - at.translation()).norm(), 1e-12);
  expect_near(found.inertia, at.linear() * whole * at.linear().transpose(), 1e-12);
}

TEST(MassProperties, FollowSteinerForTwoBalls) {
  Object dumbbell = body(Sphere{0.01});
  dumbbell.parts.push_back({pose_at(Vec3(0.1, 0, 0)), Sphere{0.01}});
  const MassProperties found = mass_properties(dumbbell);
  EXPECT_LT((found.center - Vec3(0.05, 0, 0)).norm(), 1e-15);
  const double own = 0.4 * 0.3 * 1e-4, far = 0.3 * 0.05 * 0.05;
  expect_near(found.inertia, Vec3(own, own + far, own + far).asDiagonal(), 1e-15);
}

TEST(MassProperties, OfGivenCentreAndInertiaAreThese) {
  Object object = body(Box{Vec3(0.1, 0.2, 0.3)});
  object.body->center = Vec3(0.01, 0, 0);
  const Mat3 solid = mass_properties(body(Box{Vec3(0.1, 0.2, 0.3)})).inertia;
  EXPECT_EQ(mass_properties(object).center, Vec3(0.01, 0, 0));
  expect_near(mass_properties(object).inertia, solid, 1e-18);
  object.body->inertia = Vec3(1, 2, 2.5);
  expect_near(mass_properties(object).inertia, Vec3(1, 2, 2.5).asDiagonal(), 0);
}

TEST(MassProperties, GrowWithDensity) {
  const Object object = body(Box{Vec3(0.1, 0.2, 0.3)});
  const MassProperties found = solid_mass_properties(object, 500);
  EXPECT_NEAR(found.mass, 3, 1e-12);
  EXPECT_NEAR(found.inertia(0, 0), 3.0 / 12 * (0.04 + 0.09), 1e-12);
  EXPECT_EQ(solid_mass_properties(body(Plane{}), 500).mass, 0);
}

Mesh cube_of_triangles(const Vec3& size, const Vec3& middle) {
  test::Triangles t;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    t.vertices.emplace_back((middle + sign.cwiseProduct(size)).cast<float>());
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : faces) {
    t.add(f[0], f[1], f[2]);
    t.add(f[0], f[2], f[3]);
  }
  return Mesh{.triangles = t.mesh()};
}

TEST(MassProperties, OfAMeshAreThoseOfWhatItEncloses) {
  const Vec3 size(0.1, 0.25, 0.5), middle(0.5, -0.25, 0.125);
  Mesh mesh = cube_of_triangles(size, middle);
  mesh.scale = 0.5;
  const Object found = body(mesh), box = body(Box{0.5 * size});
  EXPECT_NEAR(volume(found), volume(box), 1e-8);
  EXPECT_LT((mass_properties(found).center - 0.5 * middle).norm(), 1e-7);
  expect_near(mass_properties(found).inertia, mass_properties(box).inertia, 1e-8);
}

TEST(MassProperties, OfAMeshTurnWithItsAxes) {
  const Vec3 size(0.1, 0.25, 0.5), middle(0.5, -0.25, 0.125);
  Mesh mesh = cube_of_triangles(size, middle);
  mesh.y_up = true;
  const MassProperties found = mass_properties(body(mesh));
  EXPECT_LT((found.center - Vec3(middle.x(), -middle.z(), middle.y())).norm(), 1e-6);
  const Object box = body(Box{Vec3(size.x(), size.z(), size.y())});
  expect_near(found.inertia, mass_properties(box).inertia, 1e-7);
}

// A sheet encloses no volume, so the box around it counts.
TEST(MassProperties, OfAnOpenMeshAreThoseOfItsBox) {
  const Object found = body(
      Mesh{.triangles = test::height_field(8, 0.2, [](double x, double) { return x / 2; }).mesh()});
  EXPECT_NEAR(volume(found), 0.2 * 0.2 * 0.1, 1e-9);
}

}  // namespace
}  // namespace limpid
