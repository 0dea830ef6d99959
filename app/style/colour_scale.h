// Colours of numbers in a map, from the lowest to the highest.
#pragma once

#include "app/style/palette.h"

namespace limpid {

// Returns a colour of Viridis, which grows evenly lighter for every eye; `part` 0 to 1, held at the
// ends.
Rgb scale_colour(double part);

}  // namespace limpid
