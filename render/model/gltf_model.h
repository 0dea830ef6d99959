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

#include <atomic>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

#include "render/model/model.h"

namespace limpid {

// How far a load has come, and whether it is still wanted; either may be null.
struct LoadProgress {
  std::atomic<double>* part = nullptr;        // 0 to 1
  const std::atomic<bool>* cancel = nullptr;  // asked several times a second
};

struct LoadCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// All triangles of the default scene with the nodes' transforms applied. Kept are positions,
// normals, one set of texture coordinates, vertex colours and the metallic-roughness material with
// its textures; left out with a warning are points, lines, textures that cannot be read.
//
// Throws std::runtime_error with one line naming the file for anything unreadable, broken or
// larger than is read: 512 MiB of files, 8 million vertices and 6 million triangles over all
// nodes, 1 GiB of decoded pictures; LoadCancelled when `cancel` was set.
Model load_gltf(const std::filesystem::path& path, const LoadProgress& progress = {});

// The same from memory; `name` stands for the file in messages. Other files are read from inside
// of `folder` only; without one all of them are missing: buffers are refused, pictures left out.
Model parse_gltf(std::span<const unsigned char> bytes, const std::string& name,
                 const std::filesystem::path& folder = {}, const LoadProgress& progress = {});

}  // namespace limpid
