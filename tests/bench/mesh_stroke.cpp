#include "tests/bench/mesh_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/dynamics/inverse_kinematics.h"

namespace limpid::bench {
namespace {

constexpr double kSize = 0.05;  // radius of the body [m]
constexpr double kDepth = 0.0015;

double radius_at(const Vec3& direction) {
  const Vec3& p = direction;
  return kSize * (1 + 0.1 * std::sin(7 * p.x()) * std::sin(8 * p.y() + 1) +
                  0.01 * std::sin(40 * p.x() + 2) * std::sin(50 * p.z()));
}

Scene touching_with(const ArmDescription& arm, double tip_radius, bool capsule) {
  Scene scene;
  scene.tip_radius = tip_radius;
  if (capsule) {
    scene.probes.push_back({"link", 2, Vec3::Zero(), 0.85 * arm.tip.translation(), 0.006});
  }
  return scene;
}

}  // namespace

std::shared_ptr<const TriangleMesh> bumpy_body(std::size_t triangles) {
  const int rows = static_cast<int>(std::lround(std::sqrt(static_cast<double>(triangles) / 4)));
  const int columns = 2 * rows;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::uint32_t> indices;
  const auto add = [&](double a, double b) {
    const Vec3 d(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    vertices.push_back(Vec3(radius_at(d) * d).cast<float>());
  };
  add(0, 0);
  for (int i = 1; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      add(std::numbers::pi * i / rows, 2 * std::numbers::pi * j / columns);
    }
  }
  add(std::numbers::pi, 0);
  const auto at = [&](int i, int j) {
    if (i == 0) return 0u;
    if (i == rows) return static_cast<std::uint32_t>(vertices.size() - 1);
    return static_cast<std::uint32_t>(1 + (i - 1) * columns + j % columns);
  };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i < rows - 1) indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      if (i > 0) indices.insert(indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return std::make_shared<const TriangleMesh>(vertices, indices);
}

Scene StrokePlace::on_mesh(std::shared_ptr<const TriangleMesh> shape, double tip_radius,
                           bool capsule) const {
  Scene scene = touching_with(arm, tip_radius, capsule);
  scene.add({"", pose_at(middle), Mesh{.triangles = std::move(shape)}});
  return scene;
}

Scene StrokePlace::on_plane(double tip_radius, bool capsule) const {
  Scene scene = touching_with(arm, tip_radius, capsule);
  scene.add({"", pose_at(middle - Vec3(1.1 * kSize, 0, 0)), Plane{-Vec3::UnitX()}});
  return scene;
}

Stroke::Stroke(const StrokePlace& place, double tip_radius, const Scene& scene)
    : middle_(place.middle),
      reach_(tip_radius - kDepth),
      arm_(place.arm),
      tick_(arm_, scene),
      row_(static_cast<std::size_t>(tick_.layout().stride())) {
  const auto x = inverse_kinematics(arm_, target(0), bent(arm_));
  if (!x) throw std::runtime_error("out of reach");
  x_ = *x;
  tick_.start(p_, Start<3>::at_rest(x_));
}

Vec3 Stroke::target(int k) const {
  const double t = 1e-3 * k;
  const Vec3 d = Vec3(-1, 0.5 * std::sin(3 * t), 0.5 * std::sin(4.1 * t + 1)).normalized();
  const double lift = std::max(0.0, 0.005 * (1 - t / 0.2));
  return middle_ + (radius_at(d) + reach_ + lift) * d;
}

void Stroke::move() {
  const auto x = inverse_kinematics(arm_, target(++k_), x_);
  if (x) x_ = *x;
}

}  // namespace limpid::bench
