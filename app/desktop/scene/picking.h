// Picking: the objects and bodies under the mouse.
#pragma once

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

// Returns whether an object is met within `within` [m] of the ray's origin. Planes do not count:
// things are drawn on them. Uses a mesh's contact triangles, which answer at once whatever its
// size.
bool covered(const Ray& ray, double within, const Scene& scene, std::span<const Pose> bodies);

// Returns the object as it is in the world now.
Object placed_now(const Scene& scene, std::size_t place, std::span<const Pose> bodies);

}  // namespace limpid
