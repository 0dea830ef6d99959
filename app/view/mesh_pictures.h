// A scene's models as the 3D view wants them.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "app/run/scene_meshes.h"
#include "devices/files/scene/model_units.h"
#include "render/scene_view.h"

namespace limpid {

inline std::vector<MeshPicture> mesh_pictures(const Scene& scene, const MeshModels& models,
                                              std::optional<std::size_t> highlighted = {}) {
  std::vector<MeshPicture> pictures;
  for (std::size_t i = 0; i < std::min(scene.objects.size(), models.size()); ++i) {
    const Object& object = scene.objects[i];
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    pictures.push_back({models[i], mesh->stood(object.pose), mesh->size(), highlighted == i});
  }
  return pictures;
}

inline std::vector<VisualPicture> visual_pictures(const SceneDocument& document) {
  std::vector<VisualPicture> pictures;
  for (const SceneVisual& visual : document.visuals) {
    pictures.push_back({visual.file, visual.pose, usual_unit(visual.file) * visual.scale});
  }
  return pictures;
}

}  // namespace limpid
