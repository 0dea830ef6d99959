#include "render/near_surface.h"

#include <algorithm>
#include <cmath>

#include "core/touch/contacts.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

constexpr double kTouch = 0.02, kShade = 0.06;  // distances within which a surface counts [m]
constexpr double kSame = 0.01;  // distance from friction's limit that counts as at it [-]

using Found = std::optional<Surface>;

template <class S>
Found near(const S& shape, const Pose& pose, const Vec3& at, double) {
  return distance_to(shape, pose, at);
}

Found near(const Mesh& mesh, const Pose& pose, const Vec3& at, double within) {
  if (!mesh.triangles || !(mesh.size() > 0)) return std::nullopt;
  const Pose stood = mesh.stood(pose);
  const Vec3 local = stood.inverse() * at / mesh.size() - mesh.triangles->middle();
  MeshPoint found;
  if (!mesh.triangles->nearest(local, within / mesh.size(), MeshPoint::kNone, found))
    return std::nullopt;
  const double side = found.normal.dot(local - found.point) < 0 ? -1 : 1;
  return Surface{side * mesh.size() * found.distance, stood.linear() * found.normal};
}

Found near(const JointStop&, const Pose&, const Vec3&, double) { return std::nullopt; }

bool slips(const ContactMark& contact, const Material& material) {
  const double normal = contact.force.dot(contact.normal);
  const double along = (contact.force - normal * contact.normal).norm();
  const double share = normal > 0 ? along / normal : 0;
  const double most = std::max(material.friction_static, material.friction_kinetic);
  return share >= (1 - kSame) * most ||
         std::abs(share - material.friction_kinetic) <= kSame * material.friction_kinetic;
}

}  // namespace

std::optional<NearSurface> nearest_surface(const Scene& scene, const Vec3& at, double within,
                                           std::span<const Pose> bodies) {
  std::optional<NearSurface> nearest;
  const auto look = [&](const Object& object, const Shape& of, const Pose& pose) {
    const Found found =
        std::visit([&](const auto& shape) { return near(shape, pose, at, within); }, of);
    if (!found) return;
    const double distance = std::abs(found->distance);
    if (!(distance <= within) || (nearest && distance >= nearest->distance)) return;
    nearest = {at - found->distance * found->normal, found->normal, distance, object.material};
  };
  std::size_t body = 0;
  for (const Object& object : scene.objects) {
    const bool moved = object.body && body < bodies.size();
    const Pose& pose = moved ? bodies[body] : object.pose;
    if (object.body) ++body;
    look(object, object.shape, pose);
    for (const BodyPart& part : object.parts) look(object, part.shape, pose * part.pose);
  }
  return nearest;
}

void add_surfaces(const Scene& scene, ViewState& state) {
  for (ContactMark& contact : state.contacts) {
    const auto surface = nearest_surface(scene, contact.position, kTouch, state.bodies);
    if (!surface) continue;
    const double side = contact.force.dot(surface->normal) < 0 ? -1 : 1;
    contact.normal = side * surface->normal;
    contact.friction = surface->material.friction_static;
    contact.slips = contact.friction > 0 && slips(contact, surface->material);
  }
  state.shade.reset();
  if (state.proxy.links.empty() || !state.proxy.tip.allFinite()) return;
  if (const auto below = nearest_surface(scene, state.proxy.tip, kShade, state.bodies))
    state.shade = ContactShade{below->point, below->normal, below->distance};
}

}  // namespace limpid
