// A scene as its file has it: what can be touched, and all that goes with it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/touch/scene.h"
#include "devices/files/scene_files.h"

namespace limpid {

// Of any kind that is read.
struct ModelFile {
  std::string path;  // where it was found; empty: inside a recorded session
  ModelBytes bytes;  // with all it refers to, once its shape was built
};

// Something to look at only.
struct SceneVisual {
  std::string file;  // of a model, absolute path
  Pose pose = Pose::Identity();
  double scale = 1;
};

struct SceneDocument {
  Scene scene;
  std::string title;
  std::string about;  // one sentence for people
  std::vector<SceneVisual> visuals;
  std::map<std::string, ModelFile> models;  // by Mesh::model
  std::string toml;                         // the text it came from
};

// The models that its meshes have, as a recording keeps them; not others that may be left.
inline SceneFiles files_of(const SceneDocument& document) {
  SceneFiles files;
  for (const Object& object : document.scene.objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh != nullptr) files[mesh->model] = document.models.at(mesh->model).bytes;
  }
  return files;
}

}  // namespace limpid
