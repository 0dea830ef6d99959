// Reads models of every kind that is known: glTF 2.0, STL, OBJ, PLY and Collada.
//
//   Model part = load_model_file("part.stl");                     // a file and what it refers to
//   Model part = parse_model(bytes, "part.obj");                  // from memory, self-contained
//   Model part = parse_model(bytes, "part.obj", "/folder");       // ... and files in that folder
//
// Coordinates are those of the file, in its own unit and axes: model.unit and model.up say which,
// where the format does (glTF, Collada). Of Collada they are in metres already. No OpenGL is
// needed.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "render/model/model.h"

namespace limpid {

// Reads all triangles with their nodes' transforms applied; polygons are cut into triangles. Left
// out with a warning are points, lines, textures that cannot be read. `name` stands for the file in
// messages; its suffix says the kind, but binary glTF is known by how it begins. Other files are
// read from inside of `folder` only; without one all of them are missing. `whole`, if given,
// becomes one file that reads as the same model without others, or empty if there are no others.
//
// Throws std::runtime_error with one line naming the file for anything unreadable, broken or larger
// than is read: 512 MiB of files, 8 million vertices and 6 million triangles over all nodes, 1 GiB
// of decoded pictures; LoadCancelled when `cancel` was set.
Model parse_model(std::span<const unsigned char> bytes, const std::string& name,
                  const std::filesystem::path& folder = {}, const LoadProgress& progress = {},
                  std::vector<unsigned char>* whole = nullptr);
Model load_model_file(const std::filesystem::path& path, const LoadProgress& progress = {});

}  // namespace limpid
