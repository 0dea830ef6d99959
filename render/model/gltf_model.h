// Reads glTF 2.0 models: .glb and .gltf, with buffers and images embedded or beside the file.
//
//   Model bunny = load_gltf("bunny.gltf");                        // a file and what it refers to
//   Model part = parse_gltf(bytes, "part.glb");                   // from memory, self-contained
//   Model part = parse_gltf(bytes, "part.gltf", "/folder");       // ... and files in that folder
//   load_gltf(path, {.part = &progress.part, .cancel = &progress.cancel});  // in the background
//
// model.vertices[model.indices[3 * i + k]].position are the triangles, in metres, in glTF's own
// axes (usually y up; whoever places a model turns it). model.warnings are lines for people.
// No OpenGL is needed: link limpid_gltf.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/model/model.h"

namespace limpid {

// Reads all triangles of the default scene with the nodes' transforms applied. Kept are positions,
// normals, one set of texture coordinates, vertex colours and the metallic-roughness material with
// its textures; left out with a warning are points, lines, textures that cannot be read.
//
// Limits and errors: those of model_file.h.
Model load_gltf(const std::filesystem::path& path, const LoadProgress& progress = {});

// Reads the same from memory; `name` stands for the file in messages. Other files are read from
// inside of `folder` only; without one all of them are missing: buffers are refused, pictures left
// out.
Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name,
                 const std::filesystem::path& folder = {}, const LoadProgress& progress = {});

}  // namespace limpid
