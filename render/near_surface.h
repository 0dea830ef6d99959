// Which of a scene's surfaces a point is at, and what follows from that for the picture.
#pragma once

#include <optional>
#include <span>

#include "core/touch/scene.h"
#include "render/view_state.h"

namespace limpid {

struct NearSurface {
  Vec3 point, normal;   // on the surface [m]; unit, out of the material as far as that is known
  double distance = 0;  // of the point from it, not negative [m]
  Material material;
};

// The nearest one within so many metres. Meshes without a shape are left out. `bodies`: as
// ViewState has them.
std::optional<NearSurface> nearest_surface(const Scene& scene, const Vec3& at, double within,
                                           std::span<const Pose> bodies = {});

// Fills in what the contacts' forces do not say: the normals, friction and whether they slip; and
// the proxy's shade. A force that is no more than friction holds, and is not at the friction of
// slipping, sticks.
void add_surfaces(const Scene& scene, ViewState& state);

}  // namespace limpid
