#include "devices/files/arm/urdf_visuals.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include "devices/files/arm/urdf_numbers.h"
#include "devices/files/rpy.h"

namespace limpid {
namespace {

// Why a visual is not shown, for people.
struct NotShown {
  std::string why;
};

// As many finite numbers as asked for.
template <int N>
Numbers<N> numbers(const char* text, const std::string& what) {
  if (const auto found = numbers_in<N>(text)) return *found;
  throw NotShown{fmt::format("{} \"{}\"; needed: {} finite number{}", what,
                             text == nullptr ? "" : text, N, N == 1 ? "" : "s")};
}

Pose origin_of(const TiXmlElement& visual) {
  Pose pose = Pose::Identity();
  const TiXmlElement* origin = visual.FirstChildElement("origin");
  if (origin == nullptr) return pose;
  if (const char* xyz = origin->Attribute("xyz"))
    pose.translation() = numbers<3>(xyz, "origin xyz");
  if (const char* rpy = origin->Attribute("rpy")) {
    pose.linear() = rotation(numbers<3>(rpy, "origin rpy"));
  }
  return pose;
}

using Colours = std::map<std::string, Eigen::Vector4f>;

// Of a material that says one; colours are decoration within decoration.
std::optional<Eigen::Vector4f> colour_in(const TiXmlElement& material) {
  const TiXmlElement* colour = material.FirstChildElement("color");
  if (colour == nullptr) return std::nullopt;
  try {
    const Eigen::Vector4d rgba = numbers<4>(colour->Attribute("rgba"), "rgba");
    return rgba.cwiseMax(0).cwiseMin(1).cast<float>();
  } catch (const NotShown&) {
    return std::nullopt;
  }
}

class Reader {
 public:
  Reader(MeshFinder& meshes, UrdfPlaces& places) : meshes_(meshes), places_(places) {}

  // A material may be described anywhere, and be named elsewhere.
  void learn_colours(const TiXmlElement& inside, int depth = 0) {
    for (auto* each = inside.FirstChildElement(); each; each = each->NextSiblingElement()) {
      const char* name = each->Attribute("name");
      if (each->ValueStr() == "material" && name != nullptr) {
        if (const auto colour = colour_in(*each)) colours_.emplace(name, *colour);
      } else if (depth < 2) {
        learn_colours(*each, depth + 1);
      }
    }
  }

  // Those that can be read.
  std::vector<Visual> collisions_of(const TiXmlElement& link) {
    std::vector<Visual> all;
    for (auto* each = link.FirstChildElement("collision"); each;
         each = each->NextSiblingElement("collision")) {
      try {
        all.push_back(read(*each));
      } catch (const NotShown&) {
        continue;
      }
    }
    return all;
  }

  std::vector<Visual> visuals_of(const TiXmlElement& link, const std::string& name) {
    std::vector<Visual> all;
    for (auto* each = link.FirstChildElement("visual"); each;
         each = each->NextSiblingElement("visual")) {
      try {
        all.push_back(read(*each));
      } catch (const NotShown& e) {
        places_.warn_link(name, fmt::format("visual: {}; a plain shape stands for it", e.why));
        Visual plain;
        plain.shape = Visual::Shape::stand_in;
        all.push_back(plain);
      }
    }
    return all;
  }

 private:
  Visual read(const TiXmlElement& visual) {
    Visual out;
    out.origin = origin_of(visual);
    out.color = colour_of(visual);
    const TiXmlElement* geometry = visual.FirstChildElement("geometry");
    const TiXmlElement* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
    if (shape == nullptr) throw NotShown{"it has no geometry"};
    const std::string kind = shape->ValueStr();
    if (kind == "mesh") {
      read_mesh(*shape, out);
      return out;
    }
    if (kind == "box") {
      out.shape = Visual::Shape::box;
      out.size = numbers<3>(shape->Attribute("size"), "box size");
    } else if (kind == "cylinder" || kind == "capsule") {
      out.shape = Visual::Shape::cylinder;
      out.size = Vec3(numbers<1>(shape->Attribute("radius"), kind + " radius")[0],
                      numbers<1>(shape->Attribute("length"), kind + " length")[0], 1);
    } else if (kind == "sphere") {
      out.shape = Visual::Shape::sphere;
      out.size[0] = numbers<1>(shape->Attribute("radius"), "sphere radius")[0];
    } else {
      throw NotShown{fmt::format("geometry <{}>; known: box, cylinder, sphere, mesh", kind)};
    }
    if (out.size.minCoeff() <= 0) throw NotShown{fmt::format("the {} has no size", kind)};
    return out;
  }

  void read_mesh(const TiXmlElement& mesh, Visual& out) {
    const char* name = mesh.Attribute("filename");
    if (name == nullptr || *name == '\0') throw NotShown{"the mesh has no filename"};
    if (const char* scale = mesh.Attribute("scale")) out.size = numbers<3>(scale, "mesh scale");
    if (out.size.cwiseAbs().minCoeff() <= 0) throw NotShown{"mesh scale 0"};
    out.mesh = meshes_.find(name).string();
    if (!out.mesh.empty()) return;
    const bool package = std::string_view(name).find("://") != std::string_view::npos;
    throw NotShown{fmt::format("mesh '{}' is not found{}", name,
                               package ? " beside the URDF, in ROS_PACKAGE_PATH or in "
                                         "AMENT_PREFIX_PATH"
                                       : "")};
  }

  std::optional<Eigen::Vector4f> colour_of(const TiXmlElement& visual) const {
    const TiXmlElement* material = visual.FirstChildElement("material");
    if (material == nullptr) return std::nullopt;
    if (const auto own = colour_in(*material)) return own;
    const char* name = material->Attribute("name");
    const auto known = colours_.find(name == nullptr ? "" : name);
    return known == colours_.end() ? std::nullopt : std::optional(known->second);
  }

  MeshFinder& meshes_;
  UrdfPlaces& places_;
  Colours colours_;
};

}  // namespace

LinkShapes urdf_visuals(const TiXmlElement& robot, MeshFinder& meshes, UrdfPlaces& places) {
  Reader reader(meshes, places);
  reader.learn_colours(robot);
  LinkShapes all;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    if (const char* name = link->Attribute("name")) all[name] = reader.visuals_of(*link, name);
  }
  return all;
}

LinkShapes urdf_collisions(const TiXmlElement& robot, MeshFinder& meshes) {
  UrdfPlaces unused;
  Reader reader(meshes, unused);
  LinkShapes all;
  for (auto* link = robot.FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    if (const char* name = link->Attribute("name")) all[name] = reader.collisions_of(*link);
  }
  return all;
}

}  // namespace limpid
