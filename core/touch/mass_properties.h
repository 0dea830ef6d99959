// Mass, centre and inertia of objects that move.
#pragma once

#include "core/touch/scene.h"

namespace limpid {

struct MassProperties {
  double mass = 0;             // [kg]
  Vec3 center = Vec3::Zero();  // in the object's frame [m]
  // About the centre, along the axes of the object's frame [kg m^2].
  Mat3 inertia = Mat3::Zero();
};

// Of its shape and all of its parts; what lies in two of them counts twice. Planes and stops of
// joints have none [m^3]. A mesh that is not closed counts as the box around it; it needs its
// triangles.
double volume(const Object& object);

// Of a solid of the object's shape and parts, of the same density everywhere [kg/m^3].
MassProperties solid_mass_properties(const Object& object, double density);

// Of an object that moves: its mass, and centre and inertia as it has them, else those of a solid.
// Those of a solid belong to its own centre; where only another centre is given they move along.
MassProperties mass_properties(const Object& object);

}  // namespace limpid
