// STL, OBJ, PLY and Collada models, read by assimp. It trusts files in places, so only a program of
// its own does this: limpid-model.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "render/model/assimp/assimp_files.h"
#include "render/model/model.h"

namespace limpid {

struct AssimpModel {
  Model model;                                       // without images
  std::vector<std::vector<unsigned char>> pictures;  // encoded; Finish::color is a number in it
  bool outside = false;                              // other files were read, too
};

// `kind`: the suffix that the format has, as "stl"; no other is tried. Coordinates are those of the
// file; of Collada in metres, its up axis is not turned. `progress` is called with 0 to 1. `files`
// has the model and goes to assimp. Throws std::runtime_error with one line.
AssimpModel read_with_assimp(AssimpFiles* files, const std::string& kind,
                             const std::function<void(double)>& progress);

}  // namespace limpid
