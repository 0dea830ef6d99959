#include "render/mesh_shapes.h"

#include <cmath>
#include <numbers>

namespace limpid {
namespace {

constexpr int kSegments = 28;
constexpr double kPi = std::numbers::pi;

// A ring of a turned solid: radius, height and the normal's parts along both.
struct Ring {
  double radius, height, normal_out, normal_up;
};

std::uint32_t add(Model& model, const Vec3& position, const Vec3& normal, const Paint& paint) {
  Vertex v;
  v.position = position.cast<float>();
  v.normal = normal.normalized().cast<float>();
  v.color = paint.color;
  v.surface = {paint.metallic, paint.roughness};
  model.vertices.push_back(v);
  return static_cast<std::uint32_t>(model.vertices.size() - 1);
}

Model finished(Model model) {
  model.parts = {{0, static_cast<std::uint32_t>(model.indices.size()), {}}};
  return model;
}

// Joins rings from bottom to top; a sharp edge is a ring given twice with different normals.
Model turned(const std::vector<Ring>& rings, const Paint& paint) {
  Model m;
  for (const Ring& ring : rings)
    for (int i = 0; i <= kSegments; ++i) {
      const double a = 2 * kPi * i / kSegments;
      add(m, {ring.radius * std::cos(a), ring.radius * std::sin(a), ring.height},
          {ring.normal_out * std::cos(a), ring.normal_out * std::sin(a), ring.normal_up}, paint);
    }
  constexpr std::uint32_t kRow = kSegments + 1;
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t i = 0; i + 1 < kRow; ++i) {
      const std::uint32_t a = r * kRow + i, b = a + 1, c = a + kRow, d = c + 1;
      m.indices.insert(m.indices.end(), {a, b, d, a, d, c});
    }
  return finished(std::move(m));
}

void add_arc(std::vector<Ring>& rings, double radius, double middle, double from, double to) {
  constexpr int kSteps = 7;
  for (int i = 0; i <= kSteps; ++i) {
    const double a = from + (to - from) * i / kSteps;
    rings.push_back(
        {radius * std::cos(a), middle + radius * std::sin(a), std::cos(a), std::sin(a)});
  }
}

void add_quad(Model& m, const Vec3 (&corner)[4], const Vec3& normal, const Paint& paint) {
  std::uint32_t v[4];
  for (int i = 0; i < 4; ++i) v[i] = add(m, corner[i], normal, paint);
  m.indices.insert(m.indices.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
}

}  // namespace

float linear_light(float part) {
  return part <= 0.04045f ? part / 12.92f : std::pow((part + 0.055f) / 1.055f, 2.4f);
}

// Pushes apart the vertices of a sphere cut into eight: faces, edges and corners in one go.
Model make_box(const Vec3& size, double bevel, const Paint& paint) {
  const double r = std::min(bevel, 0.5 * size.minCoeff());
  const Vec3 inner = 0.5 * size - Vec3::Constant(r);
  constexpr int kSteps = 4;  // a quarter round
  Model m;
  for (int latitude = 0; latitude < 2 * (kSteps + 1); ++latitude)
    for (int longitude = 0; longitude < 4 * (kSteps + 1); ++longitude) {
      const int lower = latitude <= kSteps ? 0 : 1, quarter = longitude / (kSteps + 1);
      const double theta = kPi / 2 * ((latitude - lower) / double(kSteps) - 1);
      const double phi = kPi / 2 * ((longitude - quarter) / double(kSteps));
      const Vec3 n(std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi),
                   std::sin(theta));
      const Vec3 side(quarter == 0 || quarter == 3 ? 1 : -1, quarter < 2 ? 1 : -1,
                      lower == 0 ? -1 : 1);
      add(m, inner.cwiseProduct(side) + r * n, n, paint);
    }
  constexpr std::uint32_t kRow = 4 * (kSteps + 1), kRows = 2 * (kSteps + 1);
  for (std::uint32_t row = 0; row + 1 < kRows; ++row)
    for (std::uint32_t i = 0; i < kRow; ++i) {
      const std::uint32_t a = row * kRow + i, b = row * kRow + (i + 1) % kRow;
      m.indices.insert(m.indices.end(), {a, b, b + kRow, a, b + kRow, a + kRow});
    }
  for (const double s : {-1.0, 1.0}) {  // the lids
    const double x = inner.x(), y = s * inner.y(), z = s * size.z() / 2;
    add_quad(m, {{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}, {0, 0, s}, paint);
  }
  return finished(std::move(m));
}

Model make_sphere(double radius, const Paint& paint) {
  std::vector<Ring> rings;
  add_arc(rings, radius, 0, -kPi / 2, 0);
  add_arc(rings, radius, 0, 0, kPi / 2);
  return turned(rings, paint);
}

Model make_cylinder(double radius, double length, const Paint& paint) {
  const double h = length / 2;
  return turned({{0, -h, 0, -1},
                 {radius, -h, 0, -1},
                 {radius, -h, 1, 0},
                 {radius, h, 1, 0},
                 {radius, h, 0, 1},
                 {0, h, 0, 1}},
                paint);
}

Model make_capsule(const Vec3& from, const Vec3& to, double radius, const Paint& paint) {
  const double length = (to - from).norm();
  std::vector<Ring> rings;
  add_arc(rings, radius, 0, -kPi / 2, 0);
  add_arc(rings, radius, length, 0, kPi / 2);
  Model m = turned(rings, paint);
  Eigen::Affine3d place = Eigen::Translation3d(from) * Eigen::Affine3d::Identity();
  if (length > 0) place.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), to - from));
  transform(m, place);
  return m;
}

Model make_cone(const Paint& paint) {
  const double s = std::numbers::sqrt2 / 2;
  return turned({{0, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, s, s}, {0, 1, s, s}}, paint);
}

Model make_tube(const Paint& paint) {
  return turned(
      {{0, 0, 0, -1}, {1, 0, 0, -1}, {1, 0, 1, 0}, {1, 1, 1, 0}, {1, 1, 0, 1}, {0, 1, 0, 1}},
      paint);
}

Model make_sector(double inner, double outer, double angle, double thickness, const Paint& paint) {
  Model m;
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(angle) / 0.1)));
  const auto point = [&](double radius, double a, double side) {
    return Vec3(radius * std::cos(a), radius * std::sin(a), side * thickness / 2);
  };
  for (int i = 0; i < steps; ++i) {
    // Angles rise whatever the sign, so that the faces look outwards.
    const double a = std::min(0.0, angle) + std::abs(angle) * i / steps;
    const double b = a + std::abs(angle) / steps;
    const auto out = [](double t) { return Vec3(std::cos(t), std::sin(t), 0); };
    add_quad(m, {point(inner, a, 1), point(outer, a, 1), point(outer, b, 1), point(inner, b, 1)},
             Vec3::UnitZ(), paint);
    add_quad(m,
             {point(inner, b, -1), point(outer, b, -1), point(outer, a, -1), point(inner, a, -1)},
             -Vec3::UnitZ(), paint);
    add_quad(m, {point(outer, a, -1), point(outer, b, -1), point(outer, b, 1), point(outer, a, 1)},
             out((a + b) / 2), paint);
  }
  for (const double end : {std::min(0.0, angle), std::max(0.0, angle)}) {
    const double s = end == std::min(0.0, angle) ? -1 : 1;
    add_quad(
        m,
        {point(inner, end, -s), point(inner, end, s), point(outer, end, s), point(outer, end, -s)},
        s * Vec3(-std::sin(end), std::cos(end), 0), paint);
  }
  return finished(std::move(m));
}

Model make_patch(double radius, const Paint& paint) {
  Model m = turned({{0, 0, 0, 1}, {radius, 0, 0, 1}}, paint);
  for (std::size_t i = 0; i < m.indices.size(); i += 3)  // inner ring first: turn it face up
    std::swap(m.indices[i], m.indices[i + 1]);
  for (Vertex& v : m.vertices) v.uv = v.position.head<2>() / static_cast<float>(radius);
  return m;
}

void transform(Model& model, const Eigen::Affine3d& by) {
  const Eigen::Affine3f move = by.cast<float>();
  for (Vertex& v : model.vertices) {
    v.position = move * v.position;
    v.normal = (move.linear() * v.normal).normalized();
  }
}

void append(Model& model, const Model& other) {
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  model.vertices.insert(model.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const std::uint32_t i : other.indices) model.indices.push_back(first + i);
  model.parts = {{0, static_cast<std::uint32_t>(model.indices.size()), {}}};
}

}  // namespace limpid
