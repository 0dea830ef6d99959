// A look through the JSON text of a glTF file before memory is spent on it.
#pragma once

#include <span>
#include <string>

namespace limpid {

// Throws std::runtime_error naming the file for what is no JSON object, nested deeper than 64, of
// more than 8 million values or 1 million objects, or has several buffers standing for the same
// binary chunk (each would be a copy of it).
void guard_gltf_json(std::span<const unsigned char> text, const std::string& name);

}  // namespace limpid
