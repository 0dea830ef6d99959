// Bodies and sheets of triangles, for touching.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "core/touch/scene.h"
#include "core/touch/triangle_mesh.h"
#include "tests/support/random_arm.h"

namespace limpid::test {

struct Triangles {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::uint32_t> indices;

  std::size_t count() const { return indices.size() / 3; }
  Vec3 corner(std::size_t triangle, std::size_t k) const {
    return vertices[indices[3 * triangle + k]].cast<double>();
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices.insert(indices.end(), {a, b, c});
  }
  template <class Map>
  Triangles mapped(Map&& map) const {
    Triangles out = *this;
    for (Eigen::Vector3f& v : out.vertices) {
      v = Vec3(map(Vec3(v.cast<double>()))).template cast<float>();
    }
    return out;
  }
  std::shared_ptr<const TriangleMesh> mesh() const {
    return std::make_shared<const TriangleMesh>(vertices, indices);
  }
};

inline Object obstacle(const Triangles& triangles, double stiffness = 600) {
  return {"mesh", Pose::Identity(), Mesh{.triangles = triangles.mesh()}, {stiffness}};
}
inline Mesh& mesh_of(Object& obstacle) { return std::get<Mesh>(obstacle.shape); }
inline const Mesh& mesh_of(const Object& obstacle) { return std::get<Mesh>(obstacle.shape); }

// rows x columns quadrilaterals of two triangles each over [0, 1]^2, z = 0, facing +z; `wrap` joins
// the borders.
inline Triangles grid(int rows, int columns, bool wrap_rows = false, bool wrap_columns = false) {
  Triangles out;
  const int high = wrap_rows ? rows : rows + 1, wide = wrap_columns ? columns : columns + 1;
  for (int i = 0; i < high; ++i) {
    for (int j = 0; j < wide; ++j) {
      out.vertices.emplace_back(static_cast<float>(i) / static_cast<float>(rows),
                                static_cast<float>(j) / static_cast<float>(columns), 0.0f);
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i % high * wide + j % wide);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      out.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      out.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return out;
}

// A flat sheet size x size around the origin, facing +z.
inline Triangles sheet(int cells, double size) {
  return grid(cells, cells).mapped([&](const Vec3& p) {
    return Vec3(size * (p.x() - 0.5), size * (p.y() - 0.5), 0);
  });
}

// z = height(x, y) over size x size.
template <class Height>
Triangles height_field(int cells, double size, Height&& height) {
  return sheet(cells, size).mapped([&](const Vec3& p) {
    return Vec3(p.x(), p.y(), height(p.x(), p.y()));
  });
}

// Twenty triangles divided `times` times; a unit sphere seen from outside.
inline Triangles icosphere(int times) {
  const float g = static_cast<float>(std::numbers::phi);
  Triangles out;
  out.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  out.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                 4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                 6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int round = 0; round < times; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.vertices.size()));
      if (fresh) out.vertices.push_back((out.vertices[a] + out.vertices[b]) / 2);
      return at->second;
    };
    std::vector<std::uint32_t> before;
    before.swap(out.indices);
    for (std::size_t i = 0; i < before.size(); i += 3) {
      const std::uint32_t a = before[i], b = before[i + 1], c = before[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      out.add(a, ab, ca), out.add(b, bc, ab), out.add(c, ca, bc), out.add(ab, bc, ca);
    }
  }
  return out.mapped([](const Vec3& p) { return p.normalized(); });
}

// Radius of a star-shaped body in a direction: 1 with waves of height `bump`.
inline double bumpy_radius(const Vec3& direction, double bump) {
  return 1 + bump * std::sin(5 * direction.x() + 1) * std::sin(6 * direction.y() + 2) *
                 std::sin(7 * direction.z() + 3);
}
inline Triangles bumpy_body(int times, double bump) {
  return icosphere(times).mapped([&](const Vec3& p) { return Vec3(bumpy_radius(p, bump) * p); });
}

inline Triangles torus(int rows, int columns, double large, double small) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return grid(rows, columns, true, true).mapped([&](const Vec3& p) {
    const double a = kTurn * p.x(), b = kTurn * p.y(), r = large + small * std::cos(b);
    return Vec3(r * std::cos(a), r * std::sin(a), small * std::sin(b));
  });
}

// An axis-parallel box around the origin, `cells` x `cells` quadrilaterals a face.
inline Triangles box(const Vec3& size, int cells = 1) {
  Triangles out;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Triangles face = grid(cells, cells).mapped([&](const Vec3& p) {
        Vec3 q;
        q[axis] = side / 2;
        q[(axis + 1) % 3] = side > 0 ? p.x() - 0.5 : p.y() - 0.5;
        q[(axis + 2) % 3] = side > 0 ? p.y() - 0.5 : p.x() - 0.5;
        return Vec3(q.cwiseProduct(size));
      });
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.insert(out.vertices.end(), face.vertices.begin(), face.vertices.end());
      for (const std::uint32_t i : face.indices) out.indices.push_back(first + i);
    }
  }
  return out;
}

// Random triangles that share no vertices.
inline Triangles soup(std::size_t count, double size, Random& random) {
  Triangles out;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 middle = random.point(size);
    const double extent = size * std::pow(10.0, random.between(-3, 0));
    for (int k = 0; k < 3; ++k) {
      out.vertices.push_back((middle + random.point(extent)).cast<float>());
    }
    out.add(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return out;
}

}  // namespace limpid::test
