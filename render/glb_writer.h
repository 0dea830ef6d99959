// A model as a self-contained binary glTF file.
#pragma once

#include <vector>

#include "render/model.h"

namespace limpid {

// Triangles, normals and the vertices' colours; textures are left out. Read back it has the same
// corners, bit for bit, in the same order.
std::vector<unsigned char> write_glb(const Model& model);

}  // namespace limpid
