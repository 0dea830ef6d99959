#include "devices/files/arm/urdf_collisions.h"

#include <tinyxml.h>

#include "devices/files/arm/mesh_finder.h"
#include "devices/files/arm/urdf_visuals.h"

namespace limpid {

std::vector<Visual> read_collisions(const ArmDescription& arm, const std::filesystem::path& file) {
  TiXmlDocument document;
  document.Parse(arm.urdf.c_str());  // once more: the arm came from this text
  const TiXmlElement* const robot = document.RootElement();
  if (document.Error() || robot == nullptr) return {};
  MeshFinder meshes(std::filesystem::absolute(file).parent_path());
  const auto by_link = urdf_collisions(*robot, meshes);
  std::vector<Visual> all;
  for (const NamedFrame& frame : arm.frames) {
    const auto shapes = by_link.find(frame.name);
    if (shapes == by_link.end()) continue;
    for (Visual shape : shapes->second) {
      shape.link = frame.link;
      shape.origin = frame.origin * shape.origin;
      all.push_back(std::move(shape));
    }
  }
  return all;
}

}  // namespace limpid
