// The surface of a scene that a point is at, and what follows for the picture.
#pragma once

#include <optional>
#include <span>

#include "core/touch/scene.h"
#include "render/view_state.h"

namespace limpid {

struct NearSurface {
  Vec3 point, normal;   // on the surface [m]; unit, out of the material if that is known
  double distance = 0;  // from the point to the surface, not negative [m]
  Material material;
};

// Returns the surface nearest to `at` within so many metres. Leaves out meshes without a shape.
// `bodies`: as in ViewState.
std::optional<NearSurface> nearest_surface(const Scene& scene, const Vec3& at, double within,
                                           std::span<const Pose> bodies = {});

// Fills in what the contacts' forces do not say: normals, friction, slipping; and the proxy's
// shade. A contact sticks if its force is no more than friction holds and is not at the friction of
// slipping.
void add_surfaces(const Scene& scene, ViewState& state);

}  // namespace limpid
