// Nearest points and crossings of a mesh, against a search of every triangle.
#include "core/touch/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/support/meshes.h"

namespace limpid {
namespace {

using test::Random;
using test::Triangles;

constexpr double kFarthestFloat = std::numeric_limits<float>::max();

// The nearest point: the plane's, if it lies inside, otherwise the nearest on the three edges.
Vec3 nearest_by_parts(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 q = p - n.dot(p - a) * n;
  if ((b - a).cross(q - a).dot(n) >= 0 && (c - b).cross(q - b).dot(n) >= 0 &&
      (a - c).cross(q - c).dot(n) >= 0) {
    return q;
  }
  const auto on_edge = [&](const Vec3& u, const Vec3& v) {
    return Vec3(u + std::clamp((v - u).dot(p - u) / (v - u).squaredNorm(), 0.0, 1.0) * (v - u));
  };
  Vec3 best = on_edge(a, b);
  for (const Vec3& other : {on_edge(b, c), on_edge(c, a)}) {
    if ((other - p).norm() < (best - p).norm()) best = other;
  }
  return best;
}

double distance_to_all(const Triangles& soup, const Vec3& middle, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < soup.count(); ++t) {
    const Vec3 q = nearest_by_parts(p, soup.corner(t, 0) - middle, soup.corner(t, 1) - middle,
                                    soup.corner(t, 2) - middle);
    least = std::min(least, (q - p).norm());
  }
  return least;
}

struct Hit {
  double part = std::numeric_limits<double>::infinity();  // part of the way
  double least = 1;  // margin by which any triangle was hit or missed, in barycentric coordinates
};

// The first hit by Moeller and Trumbore over every triangle.
Hit first_hit(const Triangles& soup, const Vec3& middle, const Vec3& from, const Vec3& to) {
  Hit hit;
  const Vec3 d = to - from;
  for (std::size_t t = 0; t < soup.count(); ++t) {
    const Vec3 a = soup.corner(t, 0) - middle;
    const Vec3 e1 = soup.corner(t, 1) - middle - a, e2 = soup.corner(t, 2) - middle - a;
    const Vec3 h = d.cross(e2);
    const double det = e1.dot(h);
    if (det == 0) continue;
    const Vec3 s = from - a, q = s.cross(e1);
    const double u = s.dot(h) / det, v = d.dot(q) / det, part = e2.dot(q) / det;
    const double inside = std::min({u, v, 1 - u - v, part, 1 - part});
    hit.least = std::min(hit.least, std::abs(inside));
    if (inside >= 0) hit.part = std::min(hit.part, part);
  }
  return hit;
}

struct Size {
  double scale, offset;  // [m]
};
class TrianglesOfEverySize : public testing::TestWithParam<Size> {
 protected:
  Triangles soup(std::size_t count) {
    const Vec3 away = GetParam().offset * random_.direction();
    return test::soup(count, GetParam().scale, random_).mapped([&](const Vec3& p) {
      return Vec3(p + away);
    });
  }
  Random random_{301};
};
INSTANTIATE_TEST_SUITE_P(Scales, TrianglesOfEverySize,
                         testing::Values(Size{1e-3, 0}, Size{0.1, 0}, Size{10, 0}, Size{0.1, 10},
                                         Size{1, 1000}));

TEST_P(TrianglesOfEverySize, AreFoundNearestAsByAskingEachOfThem) {
  const double size = GetParam().scale;
  for (const std::size_t count : {1u, 12u, 500u}) {
    const Triangles triangles = soup(count);
    const auto mesh = triangles.mesh();
    for (int round = 0; round < 200; ++round) {
      const Vec3 p = random_.point(size * std::pow(10.0, random_.between(-1, 2)));
      const double wanted = distance_to_all(triangles, mesh->middle(), p);
      MeshPoint found;
      ASSERT_TRUE(mesh->nearest(p, kFarthestFloat, MeshPoint::kNone, found));
      // Coordinates are kept as floats around the middle.
      EXPECT_NEAR(found.distance, wanted, 2e-7 * mesh->radius());
      EXPECT_NEAR((found.point - p).norm(), found.distance, 1e-14 * (size + p.norm()));
      EXPECT_NEAR(found.normal.norm(), 1, 1e-14);
      // A limit a little larger finds the point; a little smaller finds none.
      MeshPoint again;
      EXPECT_TRUE(mesh->nearest(p, found.distance * (1 + 1e-9), MeshPoint::kNone, again));
      EXPECT_FALSE(mesh->nearest(p, found.distance * (1 - 1e-9), MeshPoint::kNone, again));
      EXPECT_FALSE(mesh->nearest(p, found.distance * (1 - 1e-9), found.triangle, again));
    }
  }
}

TEST_P(TrianglesOfEverySize, AreFoundAlikeWhateverTheHint) {
  const double size = GetParam().scale;
  const auto mesh = soup(300).mesh();
  for (int round = 0; round < 300; ++round) {
    const Vec3 p = random_.point(2 * size);
    MeshPoint plain;
    ASSERT_TRUE(mesh->nearest(p, kFarthestFloat, MeshPoint::kNone, plain));
    const auto any = static_cast<std::uint32_t>(random_.between(0, 299));
    for (const std::uint32_t hint : {plain.triangle, any, 299u, 300u, MeshPoint::kNone - 1}) {
      MeshPoint hinted;
      ASSERT_TRUE(mesh->nearest(p, kFarthestFloat, hint, hinted));
      EXPECT_EQ(hinted.distance, plain.distance);
      EXPECT_EQ(hinted.point, plain.point);
      EXPECT_EQ(hinted.normal, plain.normal);
      EXPECT_EQ(hinted.triangle, plain.triangle);
    }
  }
}

TEST_P(TrianglesOfEverySize, AreInTheWayAsByAskingEachOfThem) {
  const double size = GetParam().scale;
  const Triangles triangles = soup(200);
  const auto mesh = triangles.mesh();
  int hits = 0, misses = 0;
  for (int round = 0; round < 1000; ++round) {
    const Vec3 from = random_.point(2 * size), to = random_.point(2 * size);
    const Hit wanted = first_hit(triangles, mesh->middle(), from, to);
    if (wanted.least < 1e-3) continue;  // rounding decides
    MeshPoint found;
    const bool hit = mesh->crossing(from, to, found);
    EXPECT_EQ(hit, wanted.part <= 1);
    (hit ? hits : misses) += 1;
    if (!hit || wanted.part > 1) continue;
    EXPECT_NEAR(found.distance, wanted.part * (to - from).norm(), 1e-5 * size);
    EXPECT_LT((found.point - (from + wanted.part * (to - from))).norm(), 1e-5 * size);
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(misses, 50);
}

TEST(NearestOnTriangle, OfSliversIsOnThem) {
  // Even in a very thin triangle the result lies on it, and no point is nearer.
  Random random(302);
  for (int round = 0; round < 20000; ++round) {
    const double thin = std::pow(10.0, random.between(-8.5, 0));
    const Vec3 a = random.point(1).cast<float>().cast<double>();
    const Vec3 along = random.direction(), side = along.unitOrthogonal();
    const Vec3 b = a + along, c = a + random.between(-0.2, 1.2) * along + thin * side;
    const Vec3 p = a + random.point(std::pow(10.0, random.between(-2, 1.5)));
    const Vec3 q = nearest_on_triangle(p, a, b, c);
    const Vec3 wanted = nearest_by_parts(p, a, b, c);
    const double tolerance = 1e-13 * (1 + (p - a).norm()) + 1e-16 / thin * (p - a).norm();
    ASSERT_NEAR((q - p).norm(), (wanted - p).norm(), tolerance) << thin;
    ASSERT_LT((nearest_by_parts(q, a, b, c) - q).norm(), tolerance) << thin;
  }
}

TEST(NearestOnTriangle, IsBeneathAPointOverASliver) {
  Random random(305);
  for (int round = 0; round < 20000; ++round) {
    const double thin = std::pow(10.0, random.between(-8.5, 0));
    const Vec3 a = random.point(1).cast<float>().cast<double>();
    const Vec3 along = random.direction(), side = along.unitOrthogonal();
    const Vec3 b = a + along, c = a + random.between(0, 1) * along + thin * side;
    const Vec3 n = (b - a).cross(c - a).normalized();
    const double u = random.between(0, 1), v = random.between(0, 1 - u);
    const double height = random.between(-1, 1) * std::pow(10.0, random.between(-3, 1));
    const Vec3 beneath = a + u * (b - a) + v * (c - a);
    const Vec3 q = nearest_on_triangle(beneath + height * n, a, b, c);
    // In a sliver the place is uncertain by its corners' last digits over its width; the distance
    // is not.
    ASSERT_LT((q - beneath).norm(), 1e-14 * (1 + std::abs(height)) / thin) << thin;
    ASSERT_NEAR((q - beneath - height * n).norm(), std::abs(height),
                1e-13 * (1 + std::abs(height)) + 1e-16 / thin);
    ASSERT_LT((nearest_by_parts(q, a, b, c) - q).norm(), 1e-13 + 1e-15 / thin);
  }
}

TEST(Crossing, MissesNoSharedEdgeOfAClosedBody) {
  // From the middle to a point beyond an edge or a corner there always is a way through.
  const Triangles body = test::bumpy_body(3, 0.2);
  const auto mesh = body.mesh();
  for (std::size_t t = 0; t < body.count(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = body.corner(t, k) - mesh->middle();
      const Vec3 b = body.corner(t, (k + 1) % 3) - mesh->middle();
      for (const double part : {0.0, 0.5, 0.123}) {
        const Vec3 on_edge = a + part * (b - a);
        MeshPoint found;
        ASSERT_TRUE(mesh->crossing(-mesh->middle(), 2 * on_edge, found));
        ASSERT_TRUE(mesh->crossing(2 * on_edge, -mesh->middle(), found));
      }
    }
  }
}

TEST(Behind, IsInsideOfAClosedBody) {
  Random random(303);
  for (const double bump : {0.0, 0.2, 0.5}) {
    const auto mesh = test::bumpy_body(5, bump).mesh();
    ASSERT_TRUE(mesh->health().closed());
    int inside = 0;
    for (int round = 0; round < 3000; ++round) {
      const Vec3 p = random.point(1.6);
      const double depth = test::bumpy_radius(p.normalized(), bump) - p.norm();
      if (std::abs(depth) < 0.02) continue;  // the distance of the facets from the body
      EXPECT_EQ(mesh->behind(p - mesh->middle()), depth > 0);
      inside += depth > 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 300);
  }
}

TEST(Behind, OfASheetIsItsBack) {
  const auto mesh = test::sheet(7, 0.1).mesh();
  Random random(304);
  for (int round = 0; round < 200; ++round) {
    Vec3 p = random.point(0.04);
    EXPECT_EQ(mesh->behind(p), p.z() < 0);
  }
}

}  // namespace
}  // namespace limpid
