// The frame of a binary glTF file.
#pragma once

#include <string>
#include <vector>

namespace limpid {

// To a multiple of four.
void fill_up(std::vector<unsigned char>& bytes, unsigned char filler);

// A file of this JSON text and one buffer.
std::vector<unsigned char> glb_bytes(const std::string& json,
                                     const std::vector<unsigned char>& data);

}  // namespace limpid
