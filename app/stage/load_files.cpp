#include "app/stage/load_files.h"

#include "core/touch/triangle_mesh.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_file.h"
#include "devices/files/text_file.h"
#include "devices/files/urdf_visuals.h"
#include "render/arm_look.h"

namespace limpid {

namespace fs = std::filesystem;

LoadedScene load_scene(const fs::path& file, const ArmDescription& arm,
                       const LoadProgress& progress) {
  LoadedScene loaded{file, read_scene(file, arm), {}, {}, arm.urdf};
  loaded.models = build_meshes(loaded.document, progress);
  loaded.warnings = mesh_warnings(loaded.document.scene, loaded.models);
  return loaded;
}

LoadedModel load_model(const fs::path& file, const LoadProgress& progress) {
  SceneDocument one;
  Object& object =
      one.scene.objects.emplace_back(Object{.name = file.stem().string(), .shape = Mesh{}});
  Mesh& mesh = std::get<Mesh>(object.shape);
  mesh.model = fs::absolute(file).lexically_normal().string();
  const std::string bytes = read_text(file, scene_limits::kLargestModel);
  ModelFile& model = one.models[mesh.model];
  model.path = mesh.model;
  model.bytes = std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end());
  const MeshModels models = build_meshes(one, progress);
  const ModelAxes axes = axes_of(*models.front(), file);
  mesh.unit = axes.unit;
  mesh.y_up = axes.y_up;
  std::vector<std::string> warnings = mesh_warnings(one.scene, models);
  return {std::move(object), std::move(model), models.front(), axes, std::move(warnings)};
}

LoadedArm load_arm(const fs::path& file, const std::string& tip, Xacro xacro,
                   const LoadProgress& progress) {
  LoadedArm loaded{file, tip, read_urdf(file, tip, xacro)};
  load_visuals(loaded.arm, read_collisions(loaded.arm, file), progress);
  return loaded;
}

}  // namespace limpid
