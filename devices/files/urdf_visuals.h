// What the links of a URDF look like.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_values.h"

class TiXmlElement;

namespace limpid {

// Where the meshes that a URDF names are.

// Resolves names as ROS does. `package://NAME/path` is looked for in the packages of that name: by
// walking up from the URDF's folder to a folder NAME, or one whose package.xml says NAME; in the
// folders of ROS_PACKAGE_PATH and what lies below them; in share/NAME of those of
// AMENT_PREFIX_PATH. `model://` is the same in Gazebo's words. `file://` and plain paths are files,
// relative ones from the URDF's folder.
class MeshFinder {
 public:
  // Without a folder, as of a text inside a recording, relative names are not found.
  explicit MeshFinder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // An absolute path; empty if there is no such file.
  std::filesystem::path find(const std::string& name);

 private:
  const std::vector<std::filesystem::path>& packages(const std::string& name);

  std::filesystem::path folder_;
  std::map<std::string, std::vector<std::filesystem::path>> packages_;
};

// By the link's name, each in the link's own frame.
using LinkShapes = std::map<std::string, std::vector<Visual>>;

// Nothing is refused: what cannot be shown is a Visual::Shape::stand_in, and a warning.
LinkShapes urdf_visuals(const TiXmlElement& robot, MeshFinder& meshes, UrdfPlaces& places);

// The shapes of <collision>, without those that cannot be read.
LinkShapes urdf_collisions(const TiXmlElement& robot, MeshFinder& meshes);

// The shapes that stand for an arm's links where its makers look for collisions.

// Of an arm that was read from `file`, placed as its visuals are; without a colour. What cannot be
// read is left out: these shapes are neither seen nor touched, they only say where a link is.
std::vector<Visual> read_collisions(const ArmDescription& arm, const std::filesystem::path& file);

}  // namespace limpid
