// The colours of numbers in a map, from the lowest to the highest.
#pragma once

#include "app/style/palette.h"

namespace limpid {

// Viridis, which grows evenly lighter for every eye; `part` 0 to 1, what is beyond as its end.
Rgb scale_colour(double part);

}  // namespace limpid
