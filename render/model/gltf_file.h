// The bytes of a glTF file, checked before and parsed by tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "render/model/companions.h"

namespace limpid {

// The frame of a binary glTF file.

// To a multiple of four.
void fill_up(std::vector<unsigned char>& bytes, unsigned char filler);

// A file of this JSON text and one buffer.
std::vector<unsigned char> glb_bytes(const std::string& json,
                                     const std::vector<unsigned char>& data);

// A look through the JSON text of a glTF file before memory is spent on it.
inline constexpr const char* kOldGltf =
    "is glTF 1.0, which is not read; convert it to glTF 2.0 (gltf-pipeline does)";

// How many buffers stand for the binary chunk (each would be a copy of it). Throws
// std::runtime_error naming the file for what is no JSON object, nested deeper than 64, of more
// than 8 million values or 1 million objects, or glTF 1.
std::size_t guard_gltf_json(std::span<const unsigned char> text, const std::string& name);

// The JSON text of a file of either kind. Throws std::runtime_error naming the file.
std::span<const unsigned char> gltf_json(std::span<const unsigned char> bytes,
                                         const std::string& name);

// The list of that name, empty if there was none or something else.
nlohmann::json& gltf_list(nlohmann::json& object, const char* key);

struct GltfFile {
  tinygltf::Model gltf;
  // Encoded as they came, one each image of `gltf`; empty: in a buffer view, or missing.
  std::vector<std::vector<unsigned char>> pictures;
  std::vector<std::string> warnings;
};

// Nothing that the file refers to is checked but files, which are read from inside of `folder`
// only (from nowhere if it is empty). A buffer that is missing is an error, a picture is not.
// Throws std::runtime_error naming the file.
GltfFile parse_gltf_file(std::span<const unsigned char> bytes, const std::string& name,
                         const std::filesystem::path& folder);

}  // namespace limpid
