#include "app/run/scene_meshes.h"

#include <filesystem>
#include <future>
#include <map>

#include "app/run/model_report.h"
#include "core/touch/triangle_mesh.h"
#include "devices/files/scene/body_file.h"
#include "devices/files/text_file.h"
#include "render/model/model_file.h"
#include "render/model/simplify.h"

namespace limpid {
namespace {

std::string where(const SceneDocument& document, const Mesh& mesh) {
  const std::string& path = document.models.at(mesh.model).path;
  return path.empty() ? mesh.model : path;
}

// Builds the shape to touch beside the coarse model to draw: each takes longer than reading did.
std::shared_ptr<const Model> finished(Model model, Mesh& mesh, const std::string& name,
                                      const LoadProgress& progress) {
  std::future<std::shared_ptr<const TriangleMesh>> shape;
  if (!mesh.triangles) {
    shape = std::async([&] { return shape_of(model, name, progress.cancel); });
  }
  add_coarse(model);
  if (shape.valid()) mesh.triangles = shape.get();
  return std::make_shared<const Model>(std::move(model));
}

}  // namespace

MeshModels build_meshes(SceneDocument& document, const LoadProgress& progress) {
  std::vector<Object>& objects = document.scene.objects;
  MeshModels models(objects.size());
  std::map<std::string, std::size_t> known;  // the first object of a file
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (!has_shape<Mesh>(objects[i])) continue;
    Mesh& mesh = std::get<Mesh>(objects[i].shape);
    ModelFile& file = document.models.at(mesh.model);
    const std::string name = where(document, mesh);
    const auto [same, is_new] = known.try_emplace(name, i);
    if (!is_new) {
      const Mesh& first = std::get<Mesh>(objects[same->second].shape);
      file.bytes = document.models.at(first.model).bytes;
      mesh.triangles = first.triangles;
      models[i] = models[same->second];
      continue;
    }
    const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
    try {
      // Recordings get the model as one file: other files are gone when a recording is opened.
      std::vector<unsigned char> whole;
      Model model = parse_model(*file.bytes, name, folder, progress, &whole);
      if (!whole.empty()) {
        file.bytes = std::make_shared<const std::vector<unsigned char>>(std::move(whole));
      }
      models[i] = finished(std::move(model), mesh, name, progress);
    } catch (const LoadCancelled&) {
      throw;
    } catch (const std::exception& e) {
      throw FileError(e.what());
    }
  }
  settle_masses(document);
  return models;
}

std::vector<std::string> mesh_warnings(const Scene& scene, const MeshModels& models) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.objects[i].shape);
    if (mesh == nullptr) continue;
    const auto say = [&, start = scene.objects[i].name + ": "](const std::string& line) {
      if (!line.empty()) lines.push_back(start + line);
    };
    for (const std::string& warning : models[i]->warnings) say(warning);
    say(size_warning(*models[i], mesh->size()));
    for (const std::string& line : touch_warnings(*models[i], *mesh->triangles)) say(line);
  }
  return lines;
}

}  // namespace limpid
