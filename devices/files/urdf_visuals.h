// Appearance of a URDF's links.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/urdf_values.h"

class TiXmlElement;

namespace limpid {

// Finds the meshes that a URDF names, as ROS does. `package://NAME/path` is looked for in packages
// NAME: in folders NAME, or with a package.xml that says NAME, up from the URDF's folder; in and
// below the folders of ROS_PACKAGE_PATH; in share/NAME of those of AMENT_PREFIX_PATH. `model://`
// means the same in Gazebo. `file://` and plain paths are files, relative ones from the URDF's
// folder.
class MeshFinder {
 public:
  // If `folder` is empty (text inside a recording), relative names are not found.
  explicit MeshFinder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  // Returns an absolute path; empty if there is no such file.
  std::filesystem::path find(const std::string& name);

 private:
  const std::vector<std::filesystem::path>& packages(const std::string& name);

  std::filesystem::path folder_;
  std::map<std::string, std::vector<std::filesystem::path>> packages_;
};

// Shapes by their link's name, each in the link's own frame.
using LinkShapes = std::map<std::string, std::vector<Visual>>;

// The shapes of <visual>. Refuses nothing: what cannot be shown is a Visual::Shape::stand_in, with
// a warning.
LinkShapes urdf_visuals(const TiXmlElement& robot, MeshFinder& meshes, UrdfPlaces& places);

// The shapes of <collision>, without those that cannot be read.
LinkShapes urdf_collisions(const TiXmlElement& robot, MeshFinder& meshes);

// Collision shapes of an arm read from `file`, placed as its visuals are; without a colour. Those
// that cannot be read are left out. They are neither seen nor touched, they only say where a link
// is.
std::vector<Visual> read_collisions(const ArmDescription& arm, const std::filesystem::path& file);

}  // namespace limpid
