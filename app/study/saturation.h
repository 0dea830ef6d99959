// Motors at their limit while the tip is between walls, in corners that nobody chose.
#pragma once

#include "app/study/experiment.h"

namespace limpid {

// Adds its panels and checks.
void press_into_corners(Laboratory& lab, Outcome& outcome);

}  // namespace limpid
