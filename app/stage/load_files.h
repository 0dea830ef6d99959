// Scenes, models and arms from their files, with the models that they name.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "app/run/model_report.h"
#include "app/run/scene_meshes.h"
#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_file.h"

namespace limpid {

// Loaded scene, ready to be touched and drawn.
struct LoadedScene {
  std::filesystem::path file;
  SceneDocument document;
  MeshModels models;
  std::vector<std::string> warnings;
  std::string urdf;  // URDF of the arm that the scene was read for
};
struct LoadedModel {
  Object mesh;  // named for its file; without a place
  ModelFile file;
  std::shared_ptr<const Model> model;
  ModelAxes axes;  // of the model, as the mesh has them
  std::vector<std::string> warnings;
};
struct LoadedArm {
  std::filesystem::path file;
  std::string tip;     // the link that was chosen; empty: none
  ArmDescription arm;  // with its pictures
};
using Loaded = std::variant<LoadedScene, LoadedModel, LoadedArm>;

// Loads a scene; large files take too long for the window's thread. Errors of all three: FileError;
// LoadCancelled.
LoadedScene load_scene(const std::filesystem::path& file, const ArmDescription& arm,
                       const LoadProgress& progress = {});
LoadedModel load_model(const std::filesystem::path& file, const LoadProgress& progress = {});
LoadedArm load_arm(const std::filesystem::path& file, const std::string& tip, Xacro xacro,
                   const LoadProgress& progress = {});

}  // namespace limpid
