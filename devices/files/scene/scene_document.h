// A scene as its file has it: what can be touched, and all that goes with it.
#pragma once

#include <array>
#include <cctype>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/base/model_kinds.h"
#include "core/touch/scene.h"
#include "devices/files/scene_files.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Limits of a scene, for its file and its editors.
namespace scene_limits {

inline constexpr std::size_t kMostContacts = 64;
inline constexpr std::size_t kMostProbes = 64;                        // with the tip
inline constexpr std::size_t kLargestModel = std::size_t{512} << 20;  // [bytes]

inline constexpr Range kPosition{-10, 10, false, "m"};
inline constexpr Range kAngle{-100, 100, false, "rad"};
inline constexpr Range kLength{0, 10, true, "m"};
inline constexpr Range kRadius{0, 1, false, "m"};
inline constexpr Range kStiffness{0, 1e6, true, "N/m"};
inline constexpr Range kDamping{0, 1000, false, "N s/m"};
inline constexpr Range kFriction{0, 1};
inline constexpr Range kShare{0, 1};
inline constexpr Range kJointStiffness{0, 1e6, true, "N m/rad"};
inline constexpr Range kScale{0, 1e4, true};
// Limits of what moves.
inline constexpr std::size_t kMostSprings = 128;
inline constexpr double kForever = std::numeric_limits<double>::infinity();
inline constexpr Range kGravity{-100, 100, false, "m/s^2"};
inline constexpr Range kMass{1e-6, 100, false, "kg"};
inline constexpr Range kDensity{0, 1e5, true, "kg/m^3"};
inline constexpr Range kInertia{0, 1000, true, "kg m^2"};
inline constexpr Range kTravel{-100, 100, false, "m or rad"};
inline constexpr Range kTravelPoint{-1000, 1000};
inline constexpr Range kEndless{-kForever, kForever, false, "m or rad"};
inline constexpr Range kPeriod{0, 100, true, "m or rad"};
inline constexpr Range kJointForce{0, 1000, false, "N or N m"};
inline constexpr Range kJointSpring{0, 1e6, false, "N/m or N m/rad"};
inline constexpr Range kJointDamping{0, 1000, false, "N s/m or N m s/rad"};
inline constexpr Range kStopsStiffness{0, 1e6, true, "N/m or N m/rad"};
inline constexpr Range kSpringStiffness{0, 1e6, false, "N/m"};
inline constexpr Range kSpringLength{0, 10, false, "m"};
inline constexpr Range kBreaking{0, kForever, true, "N"};
inline constexpr Range kDirection{-1e6, 1e6};
inline constexpr Range kColor{0, 1};

}  // namespace scene_limits

// A unit that a model's coordinates may be in.
struct ModelUnit {
  const char* name;  // in scene files
  double metres;
};

inline constexpr std::array kModelUnits{ModelUnit{"m", 1}, ModelUnit{"cm", 0.01},
                                        ModelUnit{"mm", 0.001}, ModelUnit{"in", 0.0254},
                                        ModelUnit{"ft", 0.3048}};

// The unit of so many metres; null if there is none.
inline const ModelUnit* model_unit(double metres) {
  for (const ModelUnit& each : kModelUnits) {
    if (each.metres == metres) return &each;
  }
  return nullptr;
}

// The unit of a model file if the scene says none [m].
inline double usual_unit(const std::filesystem::path& file) {
  const ModelKind* const kind = model_kind(file);
  return kind == nullptr ? 1 : kind->unit;
}

// A model of any kind that can be read.
struct ModelFile {
  std::string path;  // where it was found; empty: inside a recorded session
  ModelBytes bytes;  // with all files that it refers to, once its shape is built
};

// A model to look at only.
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
  // Densities by name, of bodies whose mass waits for their mesh: see settle_masses() [kg/m^3].
  std::map<std::string, double> densities;
  std::string toml;  // the text it came from
};

// The models of the document's meshes, as a recording keeps them, without models left over.
inline SceneFiles files_of(const SceneDocument& document) {
  SceneFiles files;
  for (const Object& object : document.scene.objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh != nullptr) files[mesh->model] = document.models.at(mesh->model).bytes;
  }
  return files;
}

}  // namespace limpid
