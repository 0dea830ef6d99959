// Arms without symmetries: no axis parallel to another, nothing at an origin, no two links alike.
#pragma once

#include "core/dynamics/arm_description.h"

namespace limpid {

// Which joints of a random arm are slides: none, every third from the second on, or all.
enum class Slides { none, some, all };

// Links of about 0.1 m and 0.05 kg each, as of a desktop device. Inertias are those of real
// bodies: of four point masses.
ArmDescription random_arm(int dof, unsigned seed, Slides slides = Slides::none);

// The same arm built larger or smaller until its links weigh `mass` in all [kg]: lengths go with
// the cube root. Motors and bearings of larger links are stronger, as those of robots are; those of
// smaller ones are as they were: bearings do not get better by being small.
ArmDescription weighing(ArmDescription arm, double mass);

}  // namespace limpid
