#include "app/run/scene_meshes.h"

#include <filesystem>
#include <future>

#include "app/run/model_report.h"
#include "core/touch/triangle_mesh.h"
#include "devices/files/text_file.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"

namespace limpid {
namespace {

std::string where(const SceneDocument& document, const MeshObstacle& mesh) {
  const std::string& path = document.models.at(mesh.model).path;
  return path.empty() ? mesh.model : path;
}

// What is touched is built beside what is drawn from afar: each takes longer than reading did.
std::shared_ptr<const Model> finished(Model model, MeshObstacle& mesh, const std::string& name,
                                      const LoadProgress& progress) {
  std::future<std::shared_ptr<const TriangleMesh>> shape;
  if (!mesh.shape) {
    shape = std::async([&] { return shape_of(model, name, progress.cancel); });
  }
  add_coarse(model);
  if (shape.valid()) mesh.shape = shape.get();
  return std::make_shared<const Model>(std::move(model));
}

}  // namespace

MeshModels build_meshes(SceneDocument& document, const LoadProgress& progress) {
  MeshModels models;
  std::vector<MeshObstacle>& meshes = document.scene.meshes;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    MeshObstacle& mesh = meshes[i];
    ModelFile& file = document.models.at(mesh.model);
    const std::string name = where(document, mesh);
    std::size_t same = 0;
    while (same < i && where(document, meshes[same]) != name) ++same;
    if (same < i) {
      file.bytes = document.models.at(meshes[same].model).bytes;
      mesh.shape = meshes[same].shape;
      models.push_back(models[same]);
      continue;
    }
    const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
    try {
      // What it refers to is not there any more when a recording is opened; so recordings get one
      // file.
      std::vector<unsigned char> whole;
      Model model = parse_model(*file.bytes, name, folder, progress, &whole);
      if (!whole.empty()) {
        file.bytes = std::make_shared<const std::vector<unsigned char>>(std::move(whole));
      }
      models.push_back(finished(std::move(model), mesh, name, progress));
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception& e) {
      throw FileError(e.what());
    }
  }
  return models;
}

std::vector<std::string> mesh_warnings(const Scene& scene, const MeshModels& models) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const MeshObstacle& mesh = scene.meshes[i];
    for (const std::string& warning : models[i]->warnings) {
      lines.push_back(mesh.name + ": " + warning);
    }
    if (const std::string odd = size_warning(*models[i], mesh.size()); !odd.empty()) {
      lines.push_back(mesh.name + ": " + odd);
    }
    for (const std::string& line : touch_warnings(*models[i], *mesh.shape)) {
      lines.push_back(mesh.name + ": " + line);
    }
  }
  return lines;
}

}  // namespace limpid
