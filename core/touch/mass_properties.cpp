#include "core/touch/mass_properties.h"

#include <numbers>

#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

// Integrals over a solid: of 1, of x and of x x^T.
struct Moments {
  double volume = 0;           // [m^3]
  Vec3 first = Vec3::Zero();   // [m^4]
  Mat3 second = Mat3::Zero();  // [m^5]

  Moments& operator+=(const Moments& other) {
    volume += other.volume;
    first += other.first;
    second += other.second;
    return *this;
  }
};

// Moments of a solid that is symmetric about its origin.
Moments centered(double volume, const Vec3& squares) {
  return {volume, Vec3::Zero(), squares.asDiagonal()};
}

Moments moved(const Moments& m, const Pose& by) {
  const Vec3 shift = by.translation();
  const Vec3 turned = by.linear() * m.first;
  Moments out;
  out.volume = m.volume;
  out.first = turned + m.volume * shift;
  out.second = by.linear() * m.second * by.linear().transpose() + turned * shift.transpose() +
               shift * turned.transpose() + m.volume * shift * shift.transpose();
  return out;
}

Moments moments(const Plane&) { return {}; }
Moments moments(const JointStop&) { return {}; }

Moments moments(const Sphere& sphere) {
  const double r2 = sphere.radius * sphere.radius;
  const double volume = 4 * std::numbers::pi / 3 * r2 * sphere.radius;
  return centered(volume, Vec3::Constant(volume * r2 / 5));
}

Moments moments(const Box& box) {
  const double volume = box.size.prod();
  return centered(volume, volume / 12 * box.size.cwiseProduct(box.size));
}

Moments moments(const Cylinder& cylinder) {
  const double r2 = cylinder.radius * cylinder.radius;
  const double length = cylinder.length;
  const double volume = std::numbers::pi * r2 * length;
  return centered(volume, volume * Vec3(r2 / 4, r2 / 4, length * length / 12));
}

Moments moments(const Capsule& capsule) {
  Moments all = moments(Cylinder{capsule.radius, capsule.length});
  // Half balls: their centres are half the length away, their centres of mass 3/8 of a radius
  // beyond.
  const double r = capsule.radius, l = capsule.length;
  Moments ends = moments(Sphere{r});
  ends.second(2, 2) += ends.volume * (l * l / 4 + 3 * l * r / 8);
  return all += ends;
}

// Moments of the inside, by tetrahedra between the triangles and the origin of the mesh's own
// coordinates.
Moments inside_of(const TriangleMesh& triangles) {
  Moments all;
  for (std::size_t i = 0; i < triangles.triangles(); ++i) {
    const auto [a, b, c] = triangles.corners(i);
    const Vec3 sum = a + b + c;
    const double volume = a.dot(b.cross(c)) / 6;
    const Mat3 squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
    all += {volume, volume / 4 * sum, volume / 20 * (squares + sum * sum.transpose())};
  }
  if (all.volume < 0) all = {-all.volume, -all.first, -all.second};  // inside out
  return all;
}

Moments box_around(const TriangleMesh& triangles) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < triangles.triangles(); ++i) {
    for (const Vec3& corner : triangles.corners(i)) box.extend(corner);
  }
  return moved(moments(Box{box.sizes()}), pose_at(box.center()));
}

Moments moments(const Mesh& mesh) {
  if (!mesh.triangles) return {};
  const TriangleMesh& triangles = *mesh.triangles;
  Moments own = triangles.health().closed() ? inside_of(triangles) : Moments{};
  if (!(own.volume > 0)) own = box_around(triangles);
  const double size = mesh.size(), size3 = size * size * size;
  const Moments scaled{size3 * own.volume, size3 * size * own.first,
                       size3 * size * size * own.second};
  return moved(moved(scaled, pose_at(size * triangles.middle())), mesh.stood(Pose::Identity()));
}

Moments moments(const Object& object) {
  const auto of = [](const Shape& shape) {
    return std::visit([](const auto& s) { return moments(s); }, shape);
  };
  Moments all = of(object.shape);
  for (const BodyPart& part : object.parts) all += moved(of(part.shape), part.pose);
  return all;
}

}  // namespace

double volume(const Object& object) { return moments(object).volume; }

MassProperties solid_mass_properties(const Object& object, double density) {
  const Moments all = moments(object);
  if (!(all.volume > 0)) return {};
  MassProperties out;
  out.mass = density * all.volume;
  out.center = all.first / all.volume;
  const Mat3 about = all.second - all.volume * out.center * out.center.transpose();
  out.inertia = density * (about.trace() * Mat3::Identity() - about);
  return out;
}

MassProperties mass_properties(const Object& object) {
  if (!object.body) return {};
  const Body& body = *object.body;
  const double all = volume(object);
  MassProperties out = solid_mass_properties(object, all > 0 ? body.mass / all : 0);
  out.mass = body.mass;
  if (body.center) out.center = *body.center;
  if (body.inertia) out.inertia = body.inertia->asDiagonal();
  return out;
}

}  // namespace limpid
