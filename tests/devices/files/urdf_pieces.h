// URDF texts put together from links and joints.
#pragma once

#include <string>

#include "devices/files/urdf_file.h"

namespace limpid::test {

inline constexpr const char* kInertial =
    "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/>"
    "</inertial>";
inline constexpr const char* kLimit = "<limit lower='-1' upper='1' effort='2' velocity='1'/>";

inline std::string link(const std::string& name, const std::string& inside = kInertial) {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}

inline std::string joint(const std::string& parent, const std::string& child,
                         const std::string& type = "revolute", const std::string& inside = kLimit) {
  return "<joint name='" + parent + "_" + child + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>\n";
}

inline std::string at(const std::string& xyz) { return "<origin xyz='" + xyz + "'/>"; }

inline std::string robot(const std::string& inside) {
  return "<robot name='r'>\n" + inside + "</robot>\n";
}

inline ArmDescription parse(const std::string& inside, const std::string& tip = {}) {
  return parse_urdf(robot(inside), "x.urdf", "/nowhere", tip);
}

}  // namespace limpid::test
