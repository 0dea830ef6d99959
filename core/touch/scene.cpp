#include "core/touch/scene.h"

#include <algorithm>

namespace limpid {

std::size_t Scene::add(Object object) {
  const auto order = [](const Object& o) {
    return o.body ? std::variant_size_v<Shape> : o.shape.index();
  };
  const auto behind = std::ranges::upper_bound(objects, order(object), {}, order);
  const auto place = static_cast<std::size_t>(behind - objects.begin());
  objects.insert(behind, std::move(object));
  return place;
}

Pose pose_at(const Vec3& position) {
  Pose pose = Pose::Identity();
  pose.translation() = position;
  return pose;
}

int count_bodies(const Scene& scene) {
  return static_cast<int>(std::ranges::count_if(
      scene.objects, [](const Object& object) { return object.body.has_value(); }));
}

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const Object& object : scene.objects) {
    if (!object.body) continue;
    names.push_back(object.name.empty() ? "object " + std::to_string(names.size() + 1)
                                        : object.name);
  }
  return names;
}

double stiffest_surface(const Scene& scene) {
  double most = 0;
  for (const Object& object : scene.objects) {
    if (has_surface(object)) most = std::max(most, object.material.stiffness);
  }
  return most;
}

bool has_rubbing_surfaces(const Scene& scene) {
  return std::ranges::any_of(scene.objects, [](const Object& object) {
    const Material& m = object.material;
    return m.damping > 0 || m.friction_static > 0 || m.friction_kinetic > 0;
  });
}

void set_surface_stiffness(Scene& scene, double stiffness) {
  for (Object& object : scene.objects) {
    if (has_surface(object)) object.material.stiffness = stiffness;
  }
}

}  // namespace limpid
