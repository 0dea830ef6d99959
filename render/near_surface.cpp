#include "render/near_surface.h"

#include <algorithm>
#include <cmath>

#include "core/touch/contacts.h"
#include "core/touch/triangle_mesh.h"

namespace limpid {
namespace {

constexpr double kTouch = 0.02, kShade = 0.06;  // how far off a surface is looked for [m]
constexpr double kSame = 0.01;                  // of friction's limit: at it [-]

std::optional<Surface> distance_to(const MeshObstacle& mesh, const Vec3& at, double within) {
  if (!mesh.shape || !(mesh.size() > 0)) return std::nullopt;
  const Pose stood = mesh.stood();
  const Vec3 local = stood.inverse() * at / mesh.size() - mesh.shape->middle();
  MeshPoint found;
  if (!mesh.shape->nearest(local, within / mesh.size(), MeshPoint::kNone, found))
    return std::nullopt;
  const double side = found.normal.dot(local - found.point) < 0 ? -1 : 1;
  return Surface{side * mesh.size() * found.distance, stood.linear() * found.normal};
}

bool slips(const ContactMark& contact, const Material& material) {
  const double normal = contact.force.dot(contact.normal);
  const double along = (contact.force - normal * contact.normal).norm();
  const double share = normal > 0 ? along / normal : 0;
  const double most = std::max(material.friction_static, material.friction_kinetic);
  return share >= (1 - kSame) * most ||
         std::abs(share - material.friction_kinetic) <= kSame * material.friction_kinetic;
}

}  // namespace

std::optional<NearSurface> nearest_surface(const Scene& scene, const Vec3& at, double within) {
  std::optional<NearSurface> nearest;
  const auto look = [&](const Surface& s, const Material& material) {
    const double distance = std::abs(s.distance);
    if (!(distance <= within) || (nearest && distance >= nearest->distance)) return;
    nearest = {at - s.distance * s.normal, s.normal, distance, material};
  };
  for (const Plane& plane : scene.planes) look(distance_to(plane, at), plane.material);
  for (const Sphere& sphere : scene.spheres) look(distance_to(sphere, at), sphere.material);
  for (const Box& box : scene.boxes) look(distance_to(box, at), box.material);
  for (const MeshObstacle& mesh : scene.meshes)
    if (const auto surface = distance_to(mesh, at, within)) look(*surface, mesh.material);
  return nearest;
}

void add_surfaces(const Scene& scene, bool rubs, ViewState& state) {
  for (ContactMark& contact : state.contacts) {
    const auto surface = nearest_surface(scene, contact.position, kTouch);
    if (!surface) continue;
    const double side = contact.force.dot(surface->normal) < 0 ? -1 : 1;
    contact.normal = side * surface->normal;
    contact.friction =
        rubs && surface->material.friction_static > 0 ? surface->material.friction_static : 0;
    contact.slips = contact.friction > 0 && slips(contact, surface->material);
  }
  state.shade.reset();
  if (state.proxy.links.empty() || !state.proxy.tip.allFinite()) return;
  if (const auto below = nearest_surface(scene, state.proxy.tip, kShade))
    state.shade = ContactShade{below->point, below->normal, below->distance};
}

}  // namespace limpid
