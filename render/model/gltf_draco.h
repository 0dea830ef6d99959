// Primitives compressed with KHR_draco_mesh_compression.
#pragma once

#include "render/model/gltf_accessor.h"

namespace limpid {

inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";

// Replaces the primitive's accessors by its decompressed data; does nothing for one that is not
// compressed. Throws std::runtime_error naming the file for what cannot be read or has more than
// `most` triangles.
void decode_draco(const tinygltf::Primitive& primitive, GltfAccessor& file, std::size_t most);

}  // namespace limpid
