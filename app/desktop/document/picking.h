// What is under the mouse.
#pragma once

#include <optional>
#include <span>

#include "app/run/scene_meshes.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

// The place among the scene's objects of the first one that the ray meets; of an object that moves
// where `bodies` says that its frame is, in their order. `models`: as many as objects.
std::optional<std::size_t> object_under(const Ray& ray, const Scene& scene,
                                        const MeshModels& models, std::span<const Pose> bodies);

// The body under the ray, by the point that is there, for the mouse to pull; none where something
// that stands still is nearer.
std::optional<BodyPull> body_under(const Ray& ray, const Scene& scene, const MeshModels& models,
                                   std::span<const Pose> bodies);

// Whether one of the scene's objects is met within so many metres of the ray's origin. Planes are
// none: what is drawn lies on them.
bool covered(const Ray& ray, double within, const Scene& scene, std::span<const Pose> bodies);

// The object as it is in the world now.
Object placed_now(const Scene& scene, std::size_t place, std::span<const Pose> bodies);

}  // namespace limpid
