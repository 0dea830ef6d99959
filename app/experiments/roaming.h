// An arm that roams in free space, and eta changing meanwhile.
#pragma once

#include "app/experiments/excitation.h"
#include "app/experiments/experiment.h"

namespace limpid {

inline constexpr const char* kFreeSpace = "title = \"Free space\"\nabout = \"Nothing to touch.\"\n";
inline const Vec3 kHome(0.2, 0, -0.02);  // middle of the motion [m]

// Adds the panel of E_c and the promise that the predictive law's is none.
void roam(Laboratory& lab, Outcome& outcome);

}  // namespace limpid
