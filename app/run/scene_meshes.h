// From the models a scene names to what can be touched and drawn.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/files/scene/scene_document.h"
#include "render/model/model.h"

namespace limpid {

// What a scene's meshes look like, at the places of its objects; null for others.
using MeshModels = std::vector<std::shared_ptr<const Model>>;

// Reads the model of every mesh and builds its shape, if it has none yet. Equal files share both.
// A model that refers to other files then has them in it, so that it can be read anywhere.
// Errors: FileError naming the file; LoadCancelled.
MeshModels build_meshes(SceneDocument& document, const LoadProgress& progress = {});

// What the loader and the builder mended or left out, and sizes that may be wrong, a line each for
// people.
std::vector<std::string> mesh_warnings(const Scene& scene, const MeshModels& models);

}  // namespace limpid
