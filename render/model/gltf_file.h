// glTF files as bytes: their binary frame, the check of their JSON text, parsing by tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "render/model/companions.h"

namespace limpid {

// Appends `filler` up to a multiple of four bytes.
void fill_up(std::vector<unsigned char>& bytes, unsigned char filler);

// Returns a binary file of this JSON text and one buffer.
std::vector<unsigned char> glb_bytes(const std::string& json,
                                     const std::vector<unsigned char>& data);

inline constexpr const char* kOldGltf =
    "is glTF 1.0, which Limpid cannot read; convert it to glTF 2.0 (for example with "
    "gltf-pipeline)";

// Returns the JSON text of a file of either kind. Throws std::runtime_error naming the file.
std::span<const unsigned char> gltf_json(std::span<const unsigned char> bytes,
                                         const std::string& name);

// Returns the list of that name, made empty if there was none or something else.
nlohmann::json& gltf_list(nlohmann::json& object, const char* key);

struct GltfFile {
  tinygltf::Model gltf;
  // Encoded images, one for each of `gltf`; empty: in a buffer view, or missing.
  std::vector<std::vector<unsigned char>> pictures;
  std::vector<std::string> warnings;
};

// Parses a file; checks none of its references but those to files, which are read from inside of
// `folder` only (from nowhere if it is empty). A missing buffer is an error, a missing picture is
// not. Throws std::runtime_error naming the file.
GltfFile parse_gltf_file(std::span<const unsigned char> bytes, const std::string& name,
                         const std::filesystem::path& folder);

}  // namespace limpid
