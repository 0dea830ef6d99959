// Facts and warnings about a scene's moving objects before anybody touches them.
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

// Reports on a scene whose meshes have their triangles; empty if nothing in it moves.
BodyReport report_on_bodies(const Scene& scene, const ArmDescription& arm);

// Warns of bodies of mechanisms that springs which are drawn at the start could turn by more than
// BodyMotion::kMostTurn in a tick [s]: as fast as all energy of the springs at the body turns it
// about its axis of least inertia.
std::vector<std::string> quick_mechanisms(const Scene& scene, double tick);

// Returns the most energy that weight may give [J]: by how far each body may sink, at most to the
// lowest level plane, or without a plane as far as the tip gets.
double most_weight_energy(const Scene& scene, const ArmDescription& arm);

// Returns the energy of all springs at the start, between bodies and of their joints [J].
double spring_energy(const Scene& scene);

// Returns the least distance of the tip from the object [m]; not above 0 if the tip gets there. A
// mesh counts by the box around it.
double beyond_reach(const Object& object, const Scene& scene, const ArmDescription& arm);

// Finds pairs of objects, at least one of them moving, that are more than half a millimetre in each
// other at the start. Objects that hang on each other do not count. Moving meshes count by their
// convex hull.
std::vector<std::pair<std::size_t, std::size_t>> overlapping(const Scene& scene);

// Returns whether some body can have these principal moments: none is more than the sum of the
// other two.
bool possible_inertia(const Vec3& inertia);

}  // namespace limpid
