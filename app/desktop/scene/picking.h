// Picking: the objects and bodies under the mouse.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "app/run/scene_meshes.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

// Returns the place among the scene's objects of the first one that the ray meets. `bodies` are the
// present frames of the moving objects, in their order; `models`: as many as objects.
std::optional<std::size_t> object_under(const Ray& ray, const Scene& scene,
                                        const MeshModels& models, std::span<const Pose> bodies);

// Returns the body under the ray, with the point hit, for the mouse to pull; nothing if a fixed
// object is nearer.
std::optional<BodyPull> body_under(const Ray& ray, const Scene& scene, const MeshModels& models,
                                   std::span<const Pose> bodies);

// Place to aim at: in an object, a centimetre behind the surface, or in the middle of what is
// thinner.
struct Aim {
  std::size_t object;
  Vec3 point;  // [m]
};
// Returns the place to aim at along the ray; nothing if no object is met. Planes do not count, as
// everything stands on them. Answers as quickly as covered().
std::optional<Aim> aim_along(const Ray& ray, const Scene& scene, std::span<const Pose> bodies);

// Returns how far below the point something is, within half a metre [m]; planes count.
std::optional<double> drop_below(const Vec3& point, const Scene& scene,
                                 std::span<const Pose> bodies);

// Returns the force of a pull from one point to the other on a moving object that stands still [N].
double pull_on(const Scene& scene, std::size_t body, const std::array<Vec3, 2>& pull);

// Returns whether an object is met within `within` [m] of the ray's origin. Planes do not count:
// things are drawn on them. Uses a mesh's contact triangles, which answer at once whatever its
// size.
bool covered(const Ray& ray, double within, const Scene& scene, std::span<const Pose> bodies);

// Returns the object as it is in the world now.
Object placed_now(const Scene& scene, std::size_t place, std::span<const Pose> bodies);

}  // namespace limpid
