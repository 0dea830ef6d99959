#include "app/run/scene_meshes.h"

#include <filesystem>

#include "core/touch/triangle_mesh.h"
#include "devices/files/file_error.h"
#include "render/model/model_file.h"

namespace limpid {
namespace {

std::shared_ptr<const TriangleMesh> shape_of(const Model& model, const std::string& where,
                                             const std::atomic<bool>* cancel) {
  std::vector<Eigen::Vector3f> corners;
  corners.reserve(model.vertices.size());
  for (const Vertex& v : model.vertices) corners.push_back(v.position);
  try {
    return std::make_shared<const TriangleMesh>(corners, model.indices, cancel);
  } catch (const std::exception& e) {
    if (cancel != nullptr && cancel->load()) throw LoadCancelled(where + ": cancelled");
    throw FileError(where + ": " + e.what());
  }
}

std::string where(const SceneDocument& document, const MeshObstacle& mesh) {
  const std::string& path = document.models.at(mesh.model).path;
  return path.empty() ? mesh.model : path;
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
      models.push_back(
          std::make_shared<const Model>(parse_model(*file.bytes, name, folder, progress, &whole)));
      if (!whole.empty()) {
        file.bytes = std::make_shared<const std::vector<unsigned char>>(std::move(whole));
      }
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception& e) {
      throw FileError(e.what());
    }
    if (!mesh.shape) mesh.shape = shape_of(*models.back(), name, progress.cancel);
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
    const std::string health = mesh.shape->health().text();
    if (!health.empty()) lines.push_back(mesh.name + ": " + health);
  }
  return lines;
}

}  // namespace limpid
