// A glTF model together with the files it refers to, as one file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace limpid {

// Returns the model as a binary glTF file that holds all the buffers and pictures which lie beside
// it in `folder`. It reads as the same model without them, bit for bit; a missing picture is
// missing there, too. Empty if there is nothing to bring in: the file then stands alone as it is.
// Throws std::runtime_error naming the file for what cannot be read, or gets larger than is read.
std::vector<unsigned char> pack_gltf(std::span<const unsigned char> bytes, const std::string& name,
                                     const std::filesystem::path& folder);

}  // namespace limpid
