// Where joints and links stand in a URDF, and what was found wrong there.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace limpid {

struct UrdfPlaces {
  std::string where;
  std::map<std::string, int> joint_lines;
  std::map<std::string, int> link_lines;
  std::vector<std::string> warnings;  // a line each for people

  // Errors: FileError, always.
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_joint(const std::string& name, const std::string& why) const;
  [[noreturn]] void refuse_link(const std::string& name, const std::string& why) const;
  // What an arm can do without, or with a guess.
  void warn(const std::string& what);
  void warn_joint(const std::string& name, const std::string& what);
  void warn_link(const std::string& name, const std::string& what);
};

}  // namespace limpid
