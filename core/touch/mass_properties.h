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

// Volume of an object's shape and all of its parts; overlaps count twice [m^3]. Planes and stops of
// joints have none. A mesh that is not closed counts as the box around it; it needs its triangles.
double volume(const Object& object);

// Properties of a solid of the object's shape and parts, of uniform density [kg/m^3].
MassProperties solid_mass_properties(const Object& object, double density);

// Properties of an object that moves: its mass; its centre and inertia as given, else those of a
// solid. The solid's inertia is about its own centre, and moves along if only another centre is
// given.
MassProperties mass_properties(const Object& object);

}  // namespace limpid
