// STL, OBJ, PLY and Collada models, read by assimp.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "render/model/load_progress.h"
#include "render/model/model.h"

namespace limpid {

// As parse_model() of model_file.h. `kind`: the suffix that the format has, as "stl"; no other is
// tried. Coordinates are those of the file; of Collada in metres, its up axis is not turned.
Model parse_with_assimp(std::span<const unsigned char> bytes, const std::string& kind,
                        const std::string& name, const std::filesystem::path& folder,
                        const LoadProgress& progress);

}  // namespace limpid
