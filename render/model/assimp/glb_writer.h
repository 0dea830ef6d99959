// A model as a binary glTF file.
#pragma once

#include <string>
#include <vector>

#include "render/model/model.h"

namespace limpid {

// Writes a model as binary glTF that parse_gltf() reads as the same model, triangle for triangle
// and bit for bit. Its images are `pictures`, encoded, which the parts' Finish::color number.
// Vertices have the metallic and roughness of a new Vertex. Throws std::runtime_error for what is
// too large.
std::vector<unsigned char> glb_of(const Model& model,
                                  const std::vector<std::vector<unsigned char>>& pictures);

}  // namespace limpid
