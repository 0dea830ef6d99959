// What there is to know of a scene's moving objects before anybody touches them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"

namespace limpid {

// Lines for people.
struct BodyReport {
  std::vector<std::string> facts, warnings;
};

// Meshes have their triangles. Empty for a scene in which nothing moves.
BodyReport report_on_bodies(const Scene& scene, const ArmDescription& arm);

// The most that weight may give: how far each may sink, at most to the lowest level plane, or
// without one as far as the tip gets [J].
double most_weight_energy(const Scene& scene, const ArmDescription& arm);

// Energy of all springs at the start: those between bodies, and those of their joints [J].
double spring_energy(const Scene& scene);

// How far the tip stays away from the object at the least [m]; not above 0: it gets there. Of a
// mesh the box around it counts.
double beyond_reach(const Object& object, const Scene& scene, const ArmDescription& arm);

// Places of objects that are in each other at the start, more than half a millimetre; one of each
// two moves. What hangs on each other is none. Of moving meshes the convex hull counts.
std::vector<std::pair<std::size_t, std::size_t>> overlapping(const Scene& scene);

// Whether some body can have these principal moments: none is more than the other two together.
bool possible_inertia(const Vec3& inertia);

}  // namespace limpid
