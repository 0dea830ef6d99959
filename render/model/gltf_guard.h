// A look through the JSON text of a glTF file before memory is spent on it.
#pragma once

#include <span>
#include <string>

namespace limpid {

inline constexpr const char* kOldGltf =
    "is glTF 1.0, which is not read; convert it to glTF 2.0 (gltf-pipeline does)";

// How many buffers stand for the binary chunk (each would be a copy of it). Throws
// std::runtime_error naming the file for what is no JSON object, nested deeper than 64, of more
// than 8 million values or 1 million objects, or glTF 1.
std::size_t guard_gltf_json(std::span<const unsigned char> text, const std::string& name);

}  // namespace limpid
