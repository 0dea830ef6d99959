// Buffer views compressed with EXT_meshopt_compression.
#pragma once

#include <tiny_gltf.h>

#include <functional>
#include <span>
#include <vector>

namespace limpid {

// What a compressed view says about itself; null: it is not compressed.
const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view);

// Where the compressed bytes lie.
struct MeshoptSource {
  int buffer = 0;
  std::size_t offset = 0, length = 0;
};
MeshoptSource meshopt_source(const tinygltf::Value& extension);

// The bytes of the view, or nothing for what cannot be decoded or has more than `most` bytes.
std::vector<unsigned char> decode_meshopt(const tinygltf::Value& extension,
                                          std::span<const unsigned char> bytes, std::size_t most);

}  // namespace limpid
