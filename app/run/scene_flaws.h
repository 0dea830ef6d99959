// Flaws of a scene that can be known before anybody touches it.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/tick/parameters.h"
#include "core/touch/scene.h"

namespace limpid {

// Lists flaws of objects, in sentences: still things beyond the tip's reach (report_on_bodies() has
// those that move), walls stiffer than the law of `p` renders on this arm, kinetic friction above
// the static one, and the tip inside something at the rest pose. Meshes have their triangles.
std::vector<std::string> scene_flaws(const Scene& scene, const ArmDescription& arm,
                                     const Parameters& p);

}  // namespace limpid
