#include "app/desktop/scene/picking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/desktop/scene/scene_editor.h"
#include "core/touch/pull_link.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kPlaneReach = 0.5;   // of a plane around its point, as it is drawn [m]
constexpr double kFarthestAim = 5;    // along a ray [m]
constexpr double kAimDepth = 0.01;    // behind a surface [m]
constexpr double kDeepestDrop = 0.5;  // [m]

double at_least_zero(double way) { return way >= 0 ? way : kNone; }

// Returns the way along the ray to the shape from outside, in the shape's frame [m]; kNone: no hit.
// All way_to...() do so.
double way_to_ball(const Ray& ray, const Vec3& middle, double radius) {
  const Vec3 from = ray.origin - middle;
  const double b = from.dot(ray.direction), c = from.squaredNorm() - radius * radius;
  const double root = b * b - c;
  return root < 0 ? kNone : at_least_zero(-b - std::sqrt(root));
}

double way_to(const Ray& ray, const Sphere& sphere, const Model*) {
  return way_to_ball(ray, Vec3::Zero(), sphere.radius);
}

double way_to_box(const Ray& ray, const Bounds& box) {
  double first = -kNone, last = kNone;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min()[i] - ray.origin[i]) / ray.direction[i];
    const double b = (box.max()[i] - ray.origin[i]) / ray.direction[i];
    if (std::isnan(a) || std::isnan(b)) return kNone;  // along a face
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last ? at_least_zero(first) : kNone;
}

double way_to(const Ray& ray, const Box& box, const Model*) {
  return way_to_box(ray, {Vec3(-box.size / 2), Vec3(box.size / 2)});
}

// Returns the way to the side of a tube about z, between these heights.
double way_to_side(const Ray& ray, double radius, double half) {
  const auto o = ray.origin.head<2>(), d = ray.direction.head<2>();
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  if (root < 0 || a == 0) return kNone;
  const double way = (-b - std::sqrt(root)) / a;
  return std::abs(ray.origin.z() + way * ray.direction.z()) <= half ? at_least_zero(way) : kNone;
}

double way_to(const Ray& ray, const Cylinder& cylinder, const Model*) {
  const double half = cylinder.length / 2;
  double way = way_to_side(ray, cylinder.radius, half);
  for (const double z : {-half, half}) {
    const double there = (z - ray.origin.z()) / ray.direction.z();
    if (!std::isfinite(there)) continue;
    const Vec3 point = ray.origin + there * ray.direction;
    if (point.head<2>().norm() <= cylinder.radius) way = std::min(way, at_least_zero(there));
  }
  return way;
}

double way_to(const Ray& ray, const Capsule& capsule, const Model*) {
  const double half = capsule.length / 2;
  return std::min({way_to_side(ray, capsule.radius, half),
                   way_to_ball(ray, {0, 0, half}, capsule.radius),
                   way_to_ball(ray, {0, 0, -half}, capsule.radius)});
}

double way_to_triangle(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = ray.direction.cross(ac);
  const double det = ab.dot(p);
  if (det == 0) return kNone;
  const Vec3 from = ray.origin - a, q = from.cross(ab);
  const double u = from.dot(p) / det, v = ray.direction.dot(q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 ? at_least_zero(ac.dot(q) / det) : kNone;
}

double way_to(const Ray& ray, const Mesh&, const Model* model) {
  if (model == nullptr || way_to_box(ray, model->bounds()) == kNone) return kNone;
  double way = kNone;
  const auto corner = [&](std::size_t i) {
    return model->vertices[model->indices[i]].position.cast<double>();
  };
  for (std::size_t i = 0; i + 2 < model->indices.size(); i += 3) {
    way = std::min(way, way_to_triangle(ray, corner(i), corner(i + 1), corner(i + 2)));
  }
  return way;
}

double way_to(const Ray& ray, const Plane& plane, const Model*) {
  const double way = -ray.origin.dot(plane.normal) / ray.direction.dot(plane.normal);
  if (!std::isfinite(way)) return kNone;
  const Vec3 point = ray.origin + way * ray.direction;
  return point.norm() <= kPlaneReach ? at_least_zero(way) : kNone;
}

double way_to(const Ray&, const JointStop&, const Model*) { return kNone; }

// Returns the ray in a frame whose unit is `unit`. Ways keep their numbers, as the direction keeps
// its length in the world.
Ray in_frame(const Ray& ray, const Pose& frame, double unit = 1) {
  return {frame.inverse() * ray.origin / unit, frame.linear().transpose() * ray.direction / unit};
}

// Returns the way [m], whatever the unit of the direction: shapes are met at a number of
// directions.
double way_to(const Ray& ray, const Shape& shape, const Pose& pose, const Model* model) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    return way_to(in_frame(ray, mesh->stood(pose), mesh->size()), *mesh, model);
  }
  if (const auto* plane = std::get_if<Plane>(&shape)) {
    return way_to({ray.origin - pose.translation(), ray.direction}, *plane, model);
  }
  const Ray local = in_frame(ray, pose);
  return std::visit([&](const auto& each) { return way_to(local, each, model); }, shape);
}

// Returns the way to the object's shape or to its nearest part.
double way_to(const Ray& ray, const Object& object, const Model* model) {
  double way = way_to(ray, object.shape, object.pose, model);
  for (const BodyPart& part : object.parts) {
    way = std::min(way, way_to(ray, part.shape, object.pose * part.pose, nullptr));
  }
  return way;
}

// Returns the way to the object, by a mesh's contact triangles; kNone beyond `within`.
double quick_way_to(const Ray& ray, const Object& object, double within) {
  const double way = way_to(ray, object, nullptr);
  const auto* mesh = std::get_if<Mesh>(&object.shape);
  if (mesh == nullptr || !mesh->triangles) return way;
  const Ray local = in_frame(ray, mesh->stood(object.pose), mesh->size());
  const Vec3 from = local.origin - mesh->triangles->middle();
  MeshPoint met;
  if (!mesh->triangles->crossing(from, from + within * local.direction, met)) return way;
  return std::min(way, (met.point - from).norm() / local.direction.norm());
}

struct Met {
  std::size_t object = 0;
  double way = kNone;  // along the ray [m]
};

// Returns the first object along the ray.
Met first_met(const Ray& ray, const Scene& scene, const MeshModels& models,
              std::span<const Pose> bodies) {
  Met met;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const double way = way_to(ray, placed_now(scene, i, bodies), models.at(i).get());
    if (way < met.way) met = {i, way};
  }
  return met;
}

// Returns the number of a moving object as the loop counts such objects.
int number_of_body(const Scene& scene, std::size_t place) {
  int number = 0;
  for (std::size_t i = 0; i < place; ++i) number += scene.objects[i].body ? 1 : 0;
  return number;
}

}  // namespace

Object placed_now(const Scene& scene, std::size_t place, std::span<const Pose> bodies) {
  Object object = scene.objects.at(place);
  if (!object.body) return object;
  const auto body = static_cast<std::size_t>(number_of_body(scene, place));
  if (body < bodies.size() && bodies[body].matrix().allFinite()) object.pose = bodies[body];
  return object;
}

bool covered(const Ray& ray, double within, const Scene& scene, std::span<const Pose> bodies) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (std::holds_alternative<Plane>(scene.objects[i].shape)) continue;
    if (quick_way_to(ray, placed_now(scene, i, bodies), within) < within) return true;
  }
  return false;
}

std::optional<Aim> aim_along(const Ray& ray, const Scene& scene, std::span<const Pose> bodies) {
  std::optional<Aim> aim;
  double first = kFarthestAim;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (std::holds_alternative<Plane>(scene.objects[i].shape)) continue;
    const Object object = placed_now(scene, i, bodies);
    const double way = quick_way_to(ray, object, first);
    if (!(way < first)) continue;
    first = way;
    const Ray back{ray.origin + kFarthestAim * ray.direction, -ray.direction};
    const double thick = kFarthestAim - quick_way_to(back, object, kFarthestAim) - way;
    const double deep = std::clamp(0.5 * thick, 0.0, kAimDepth);
    aim = Aim{i, ray.origin + (way + deep) * ray.direction};
  }
  return aim;
}

double pull_on(const Scene& scene, std::size_t body, const std::array<Vec3, 2>& pull) {
  for (const Object& object : scene.objects) {
    if (!object.body || body-- > 0) continue;
    return PullLink::force_of(object.body->mass, (pull[1] - pull[0]).norm());
  }
  return 0;
}

std::optional<double> drop_below(const Vec3& point, const Scene& scene,
                                 std::span<const Pose> bodies) {
  const Ray down{point, -Vec3::UnitZ()};
  double drop = kDeepestDrop;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    drop = std::min(drop, quick_way_to(down, placed_now(scene, i, bodies), drop));
  }
  return drop < kDeepestDrop ? std::optional(drop) : std::nullopt;
}

std::optional<std::size_t> object_under(const Ray& ray, const Scene& scene,
                                        const MeshModels& models, std::span<const Pose> bodies) {
  const Met met = first_met(ray, scene, models, bodies);
  return met.way < kNone ? std::optional(met.object) : std::nullopt;
}

std::optional<BodyPull> body_under(const Ray& ray, const Scene& scene, const MeshModels& models,
                                   std::span<const Pose> bodies) {
  const Met met = first_met(ray, scene, models, bodies);
  if (!(met.way < kNone) || !scene.objects[met.object].body) return std::nullopt;
  const Vec3 point = ray.origin + met.way * ray.direction;
  return BodyPull{number_of_body(scene, met.object),
                  placed_now(scene, met.object, bodies).pose.inverse() * point, point};
}

}  // namespace limpid
