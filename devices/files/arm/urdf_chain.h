// From urdfdom's tree of links to the chain that the loop computes with.
#pragma once

#include <urdf_model/model.h>

#include <filesystem>
#include <map>
#include <string>

#include "core/dynamics/arm_description.h"

namespace limpid {

// Where joints and links stand in the file, for messages.
struct UrdfPlaces {
  std::string where;
  std::map<std::string, int> joint_lines;
  std::map<std::string, int> link_lines;

  [[noreturn]] void refuse_joint(const std::string& name, const std::string& why) const;
  [[noreturn]] void refuse_link(const std::string& name, const std::string& why) const;
};

// Errors: FileError, as read_urdf.
ArmDescription chain_of(const urdf::ModelInterface& model, const UrdfPlaces& places,
                        const std::filesystem::path& base_dir);

}  // namespace limpid
