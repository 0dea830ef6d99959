// What the links of a URDF look like.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "devices/files/arm/mesh_finder.h"
#include "devices/files/arm/urdf_places.h"

class TiXmlElement;

namespace limpid {

// By the link's name, each in the link's own frame.
using LinkShapes = std::map<std::string, std::vector<Visual>>;

// Nothing is refused: what cannot be shown is a Visual::Shape::stand_in, and a warning.
LinkShapes urdf_visuals(const TiXmlElement& robot, MeshFinder& meshes, UrdfPlaces& places);

// The shapes of <collision>, without those that cannot be read.
LinkShapes urdf_collisions(const TiXmlElement& robot, MeshFinder& meshes);

}  // namespace limpid
