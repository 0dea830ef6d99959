// A coarse version of a large model for slow renderers and for shadows.
#pragma once

#include "render/model/model.h"

namespace limpid {

// Fills model.coarse and model.coarse_parts with about `triangles` triangles over the same
// vertices; leaves them empty for models of fewer than twice as many.
void add_coarse(Model& model, std::size_t triangles = 50'000);

}  // namespace limpid
