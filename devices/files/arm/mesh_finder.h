// Where the meshes that a URDF names are.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace limpid {

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

}  // namespace limpid
