// Where something new goes: in reach, on the table, not around the tip.
#pragma once

#include <optional>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "core/touch/scene.h"
#include "render/camera.h"

namespace limpid {

// What a place depends on.
struct Workplace {
  Vec3 base = Vec3::Zero();   // where the arm stands [m]
  double reach = 0;           // from there [m]
  Vec3 rest = Vec3::Zero();   // the tip in the middle of its room [m]
  std::vector<Vec3> tips;     // where tips are now, of device and proxy [m]
  std::vector<Bounds> taken;  // by other objects [m]
};

// The height of the highest level plane below `rest`, if there is one [m].
std::optional<double> table_height(const Scene& scene, const Vec3& rest);

// The middle of a box of this size [m]: on the table, else at the height of `rest`; as near to
// `rest` as tips and other objects leave room, rather in front of the arm than beside it.
Vec3 find_place(const Vec3& size, std::optional<double> table, const Workplace& at);

// A scale that makes a model of this largest extent [m] one to be touched: 1 between 2 and 20 cm,
// else what makes it 8 cm, in round numbers.
double handy_scale(double extent);

// Scales a mesh of these bounds (as its file has them) and gives it a place, upright.
void place_mesh(Object& mesh, const Bounds& model, const Scene& scene, const Workplace& at);

}  // namespace limpid
