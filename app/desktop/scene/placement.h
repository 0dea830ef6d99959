// Placement of new objects: in reach, on the table, not around the tip.
#pragma once

#include <optional>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

// Surroundings that a place depends on.
struct Workplace {
  Vec3 base = Vec3::Zero();   // where the arm stands [m]
  double reach = 0;           // distance from `base` [m]
  Vec3 rest = Vec3::Zero();   // the tip in the middle of its room [m]
  std::vector<Vec3> tips;     // present tips of device and proxy [m]
  std::vector<Bounds> taken;  // room of other objects [m]
};

// Returns the height of the highest level plane below `rest`, if there is one [m].
std::optional<double> table_height(const Scene& scene, const Vec3& rest);

// Returns the middle of a box of this size [m]: on the table, else at the height of `rest`. It is
// as near to `rest` as tips and other objects allow, rather in front of the arm than beside it.
Vec3 find_place(const Vec3& size, std::optional<double> table, const Workplace& at);

// Returns a scale for a model of this largest extent [m]: 1 between 2 and 20 cm, else a round
// number that makes it about 8 cm.
double handy_scale(double extent);

// Scales a mesh with these bounds (as its file has them) and gives it a place, upright.
void place_mesh(Object& mesh, const Bounds& model, const Scene& scene, const Workplace& at);

}  // namespace limpid
