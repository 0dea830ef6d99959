#include "devices/files/arm/urdf_places.h"

#include <fmt/format.h>

#include "devices/files/file_error.h"

namespace limpid {
namespace {

std::string at(const std::string& where, const std::map<std::string, int>& lines, const char* kind,
               const std::string& name, const std::string& what) {
  const auto line = lines.find(name);
  return one_line(fmt::format("{}{}: {} '{}': {}", where,
                              line == lines.end() ? "" : fmt::format(":{}", line->second), kind,
                              name, what));
}

}  // namespace

void UrdfPlaces::refuse(const std::string& why) const {
  throw FileError(fmt::format("{}: {}", where, why));
}

void UrdfPlaces::refuse_joint(const std::string& name, const std::string& why) const {
  throw FileError(at(where, joint_lines, "joint", name, why));
}

void UrdfPlaces::refuse_link(const std::string& name, const std::string& why) const {
  throw FileError(at(where, link_lines, "link", name, why));
}

void UrdfPlaces::warn(const std::string& what) {
  warnings.push_back(one_line(fmt::format("{}: {}", where, what)));
}

void UrdfPlaces::warn_joint(const std::string& name, const std::string& what) {
  warnings.push_back(at(where, joint_lines, "joint", name, what));
}

void UrdfPlaces::warn_link(const std::string& name, const std::string& what) {
  warnings.push_back(at(where, link_lines, "link", name, what));
}

}  // namespace limpid
