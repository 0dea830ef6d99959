// Models of a scene, read and made ready to be touched and drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/files/scene/scene_document.h"
#include "render/model/model.h"

namespace limpid {

// Models to be drawn for a scene's meshes, at the places of its objects; null for others.
using MeshModels = std::vector<std::shared_ptr<const Model>>;

// Reads the model of every mesh and builds its shape, if it has none yet. Equal files share both.
// Puts the files that a model refers to into it, so that it can be read anywhere. Errors: FileError
// naming the file; LoadCancelled.
MeshModels build_meshes(SceneDocument& document, const LoadProgress& progress = {});

// Lists for people what the loader and the builder mended or left out, and sizes that may be wrong,
// a line each.
std::vector<std::string> mesh_warnings(const Scene& scene, const MeshModels& models);

}  // namespace limpid
