// Reads a glTF 2.0 file: binary (.glb), or text with everything embedded.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/model.h"

namespace limpid {

// All triangles of the default scene with the nodes' transforms applied, in glTF's own axes and
// metres. Base colour (factor, texture, vertex colours), metallic and roughness are kept.
// Throws std::runtime_error naming the file for anything unreadable, broken, larger than 64 MiB
// or outside of what is drawn (skins, animations and other files are not read).
Model load_gltf(const std::filesystem::path& path);

// The same from memory; `name` stands for the file in messages.
Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name);

}  // namespace limpid
