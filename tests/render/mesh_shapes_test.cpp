// Solids that the view makes itself: their size, volume and normals against closed forms.
#include "render/mesh_shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace limpid {
namespace {

constexpr double kPi = std::numbers::pi;
const Paint kRed{{0.9f, 0.1f, 0.2f}, 0.3f, 0.7f};

struct Triangle {
  Vec3 a, b, c, normal;  // normal: the mean of its corners'

  Vec3 area() const { return (b - a).cross(c - a) / 2; }
};

std::vector<Triangle> triangles(const Model& model) {
  std::vector<Triangle> all;
  for (std::size_t i = 0; i < model.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return model.vertices.at(model.indices[i + k]); };
    const auto place = [&](std::size_t k) { return Vec3(at(k).position.cast<double>()); };
    const Eigen::Vector3f normal = at(0).normal + at(1).normal + at(2).normal;
    all.push_back({place(0), place(1), place(2), normal.cast<double>().normalized()});
  }
  return all;
}

// Volume by the divergence theorem.
double volume(const Model& model) {
  double sum = 0;
  for (const Triangle& t : triangles(model)) sum += t.a.dot(t.b.cross(t.c)) / 6;
  return sum;
}

// Area of the triangles that look along a direction.
double area_along(const Model& model, const Vec3& direction) {
  double sum = 0;
  for (const Triangle& t : triangles(model)) {
    if (t.area().norm() > 0 && t.area().normalized().dot(direction) > 0.99) sum += t.area().norm();
  }
  return sum;
}

// Every triangle looks where its corners' normals do, and is painted.
void expect_sound(const Model& model) {
  for (const Vertex& v : model.vertices) {
    EXPECT_NEAR(v.normal.norm(), 1, 1e-5);
    EXPECT_EQ(v.color, kRed.color);
    EXPECT_EQ(v.surface, Eigen::Vector2f(0.3f, 0.7f));
  }
  for (const Triangle& t : triangles(model)) {
    if (t.area().norm() < 1e-10) continue;  // at a pole
    EXPECT_GT(t.area().normalized().dot(t.normal), 0.7);
  }
  ASSERT_EQ(model.parts.size(), 1u);
  EXPECT_EQ(model.parts[0].count, model.indices.size());
}

void expect_bounds(const Model& model, const Vec3& min, const Vec3& max) {
  EXPECT_LT((model.bounds().min() - min).cwiseAbs().maxCoeff(), 0.01 * (max - min).norm());
  EXPECT_LT((model.bounds().max() - max).cwiseAbs().maxCoeff(), 0.01 * (max - min).norm());
}

TEST(MeshShapes, BoxHasItsSizeAndRoundEdges) {
  const Vec3 size(0.2, 0.3, 0.4);
  const Model box = make_box(size, 0.01, kRed);
  expect_sound(box);
  expect_bounds(box, -size / 2, size / 2);
  EXPECT_LT(volume(box), size.prod());
  EXPECT_GT(volume(box), 0.98 * size.prod());
  EXPECT_NEAR(area_along(box, Vec3::UnitX()), 0.28 * 0.38, 1e-3) << "less its edges";
  EXPECT_NEAR(area_along(box, -Vec3::UnitZ()), 0.18 * 0.28, 1e-3);
  const Model ball = make_box(Vec3::Constant(0.2), 1, kRed);
  EXPECT_NEAR(volume(ball), 4.0 / 3 * kPi * 1e-3, 0.12 * 4e-3) << "no rounder than a ball";
}

TEST(MeshShapes, TurnedSolidsHaveTheirVolume) {
  const Model sphere = make_sphere(0.5, kRed), cylinder = make_cylinder(0.2, 0.6, kRed),
              cone = make_cone(kRed), tube = make_tube(kRed);
  for (const Model* each : {&sphere, &cylinder, &cone, &tube}) expect_sound(*each);
  expect_bounds(sphere, Vec3::Constant(-0.5), Vec3::Constant(0.5));
  expect_bounds(cylinder, {-0.2, -0.2, -0.3}, {0.2, 0.2, 0.3});
  expect_bounds(cone, {-1, -1, 0}, {1, 1, 1});
  expect_bounds(tube, {-1, -1, 0}, {1, 1, 1});
  EXPECT_NEAR(volume(sphere) / (4.0 / 3 * kPi * 0.125), 1, 0.04);
  EXPECT_NEAR(volume(cylinder) / (kPi * 0.04 * 0.6), 1, 0.02);
  EXPECT_NEAR(volume(cone) / (kPi / 3), 1, 0.02);
  EXPECT_NEAR(volume(tube) / kPi, 1, 0.02);
}

TEST(MeshShapes, CapsuleReachesFromEndToEnd) {
  const Vec3 from(0.1, -0.2, 0.3), to(0.4, 0.2, 0.3);
  const double r = 0.05, length = (to - from).norm();
  const Model capsule = make_capsule(from, to, r, kRed);
  expect_sound(capsule);
  EXPECT_NEAR(volume(capsule) / (kPi * r * r * length + 4.0 / 3 * kPi * r * r * r), 1, 0.03);
  const Vec3 along = (to - from) / length;
  double least = 1, most = -1;
  for (const Vertex& v : capsule.vertices) {
    const Vec3 p = v.position.cast<double>() - from;
    const double at = std::clamp(p.dot(along), 0.0, length);
    EXPECT_NEAR((p - at * along).norm(), r, 1e-6) << "as far from its axis everywhere";
    least = std::min(least, p.dot(along));
    most = std::max(most, p.dot(along));
  }
  EXPECT_NEAR(least, -r, 1e-6);
  EXPECT_NEAR(most, length + r, 1e-6);
  const Model point = make_capsule(from, from, r, kRed);
  EXPECT_NEAR(volume(point) / (4.0 / 3 * kPi * r * r * r), 1, 0.04) << "a ball";
}

TEST(MeshShapes, SectorIsASliceOfADisc) {
  for (const double angle : {0.5, -0.5}) {
    const Model sector = make_sector(0.1, 0.4, angle, 0.06, kRed);
    expect_sound(sector);
    const double lid = std::abs(angle) / 2 * (0.4 * 0.4 - 0.1 * 0.1);
    EXPECT_NEAR(area_along(sector, Vec3::UnitZ()) / lid, 1, 0.01);
    EXPECT_NEAR(area_along(sector, -Vec3::UnitZ()) / lid, 1, 0.01);
    EXPECT_NEAR(area_along(sector, Vec3(0, angle > 0 ? -1 : 1, 0)), 0.3 * 0.06, 1e-6)
        << "where it begins";
    for (const Vertex& v : sector.vertices) {
      const double at = std::atan2(v.position.y(), v.position.x());
      EXPECT_GE(at, std::min(0.0, angle) - 1e-6);
      EXPECT_LE(at, std::max(0.0, angle) + 1e-6);
      EXPECT_NEAR(std::abs(v.position.z()), 0.03, 1e-7);
      const double radius = std::hypot(v.position.x(), v.position.y());
      EXPECT_NEAR(radius, radius < 0.25 ? 0.1 : 0.4, 1e-6);
    }
  }
}

TEST(MeshShapes, PatchIsFlatAndHasPlacesOnAPicture) {
  const Model patch = make_patch(0.3, kRed);
  expect_sound(patch);
  EXPECT_NEAR(area_along(patch, Vec3::UnitZ()) / (kPi * 0.09), 1, 0.02);
  for (const Vertex& v : patch.vertices) {
    EXPECT_EQ(v.position.z(), 0);
    EXPECT_LT((v.uv * 0.3f - v.position.head<2>()).norm(), 1e-6f);
  }
}

TEST(MeshShapes, AreMovedWithTheirNormalsAndPutTogether) {
  Model all = make_cylinder(0.1, 0.4, kRed);
  const std::size_t vertices = all.vertices.size(), indices = all.indices.size();
  Model other = make_sphere(0.2, kRed);
  transform(other,
            Eigen::Affine3d(Eigen::Translation3d(1, 2, 3) *
                            Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()) * Eigen::Scaling(2.0)));
  expect_sound(other);
  expect_bounds(other, Vec3(0.6, 1.6, 2.6), Vec3(1.4, 2.4, 3.4));
  const double both = volume(all) + volume(other);
  append(all, other);
  expect_sound(all);
  EXPECT_EQ(all.vertices.size(), vertices + other.vertices.size());
  EXPECT_EQ(all.indices.size(), indices + other.indices.size());
  EXPECT_NEAR(volume(all), both, 1e-6);
}

// IEC 61966-2-1, the standard of screens.
TEST(LightOfAScreen, FollowsTheStandard) {
  EXPECT_EQ(linear_light(0), 0);
  EXPECT_NEAR(linear_light(1), 1, 1e-6);
  EXPECT_NEAR(linear_light(0.5f), 0.21404f, 1e-5f);
  EXPECT_NEAR(linear_light(0.02f), 0.02f / 12.92f, 1e-7f);
  EXPECT_NEAR(linear_light(0.0405f), linear_light(0.0404f), 2e-5f) << "both parts meet";
}

}  // namespace
}  // namespace limpid
