// Random arms without symmetries: no axis parallel to another, nothing at an origin, no two links
// alike.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

// Slides among the joints of a random arm: none, every third joint from the second on, or all.
enum class Slides { none, some, all };

// Makes an arm with links of about 0.1 m and 0.05 kg, as of a desktop device. Their inertias are
// those of real bodies: of four point masses.
ArmDescription random_arm(int dof, unsigned seed, Slides slides = Slides::none);

// Scales an arm until its links weigh `mass` in all [kg]; lengths go with the cube root. Motors and
// bearings of larger links are stronger, as in robots. Those of smaller links keep their values:
// bearings do not improve by being small.
ArmDescription weighing(ArmDescription arm, double mass);

}  // namespace limpid
