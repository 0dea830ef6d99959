#include "devices/files/urdf_visuals.h"

#include <fmt/format.h>
#include <tinyxml.h>

#include <algorithm>
#include <fstream>

#include "devices/files/rpy.h"
#include "devices/files/urdf_source.h"
#include "devices/files/urdf_values.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr int kMostFolders = 4000;                 // most folders looked into for one package
constexpr int kDeepestFolder = 6;                  // below a folder of ROS_PACKAGE_PATH
constexpr std::size_t kLongestManifest = 1 << 20;  // [bytes]

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// The name of a package in its package.xml; empty if there is no such file.
std::string package_name(const fs::path& folder) {
  const fs::path manifest = folder / "package.xml";
  if (!is_file(manifest)) return {};
  std::ifstream file(manifest, std::ios::binary);
  std::string text(kLongestManifest, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  const auto from = text.find("<name>"), to = text.find("</name>");
  if (from == std::string::npos || to == std::string::npos || to < from) return {};
  const std::string name = text.substr(from + 6, to - from - 6);
  const auto first = name.find_first_not_of(" \t\r\n"), last = name.find_last_not_of(" \t\r\n");
  return first == std::string::npos ? "" : name.substr(first, last - first + 1);
}

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code error;
  for (fs::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    if (all.size() >= kMostFolders) break;
    if (each->path().filename().string().starts_with('.')) continue;
    if (each->is_directory(error)) all.push_back(each->path());
  }
  std::ranges::sort(all);  // same order everywhere
  return all;
}

// Finds packages below a folder as ROS crawls: packages have no packages inside.
void crawl(const fs::path& folder, const std::string& name, int depth, int& left,
           std::vector<fs::path>& found) {
  if (--left < 0 || depth > kDeepestFolder) return;
  if (const std::string own = package_name(folder); !own.empty()) {
    if (own == name) found.push_back(folder);
    return;
  }
  for (const fs::path& each : folders_in(folder)) crawl(each, name, depth + 1, left, found);
}

// Error of a visual that is not shown, with the reason for people.
struct NotShown {
  std::string why;
};

// N finite numbers; NotShown if `text` is anything else.
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
  if (const char* xyz = origin->Attribute("xyz")) {
    pose.translation() = numbers<3>(xyz, "origin xyz");
    if (const std::string why = refused_origin(pose.translation()); !why.empty()) {
      throw NotShown{why};
    }
  }
  if (const char* rpy = origin->Attribute("rpy")) {
    pose.linear() = rotation(numbers<3>(rpy, "origin rpy"));
  }
  return pose;
}

using Colours = std::map<std::string, Eigen::Vector4f>;

// The colour that a material says; nothing if it is missing or wrong, as colours are mere
// decoration.
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

  // Remembers colours by name: a material may be described anywhere, and named elsewhere.
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

  // The collision shapes that can be read.
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
        places_.warn_link(name, fmt::format("visual: {}; a plain shape is shown instead", e.why));
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
    throw NotShown{fmt::format(
        "mesh '{}' is not found{}", name,
        package ? " near the URDF file, in ROS_PACKAGE_PATH or in AMENT_PREFIX_PATH" : "")};
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

const std::vector<fs::path>& MeshFinder::packages(const std::string& name) {
  const auto [place, fresh] = packages_.try_emplace(name);
  std::vector<fs::path>& found = place->second;
  if (!fresh) return found;
  if (!folder_.empty()) {
    int left = kMostFolders;
    for (fs::path at = fs::absolute(folder_).lexically_normal();; at = at.parent_path()) {
      if (at.filename() == name || package_name(at) == name) found.push_back(at);
      if (is_folder(at / name)) found.push_back(at / name);
      if (at == at.parent_path()) break;
      for (const fs::path& each : folders_in(at)) {
        if (--left > 0 && package_name(each) == name) found.push_back(each);
      }
    }
  }
  for (const fs::path& path : search_path("ROS_PACKAGE_PATH")) {
    if (is_folder(path / name)) found.push_back(path / name);
    int left = kMostFolders;
    crawl(path, name, 0, left, found);
  }
  for (const fs::path& path : search_path("AMENT_PREFIX_PATH")) {
    found.push_back(path / "share" / name);
  }
  return found;
}

fs::path MeshFinder::find(const std::string& name) {
  const auto present = [](const fs::path& path) {
    return is_file(path) ? fs::absolute(path).lexically_normal() : fs::path();
  };
  const std::size_t scheme = name.find("://");
  if (scheme == std::string::npos) {
    const fs::path file = name;
    if (file.is_relative() && folder_.empty()) return {};
    return present(folder_ / file);
  }
  const std::string kind = name.substr(0, scheme), rest = name.substr(scheme + 3);
  if (kind == "file") return present("/" + rest.substr(std::min(rest.find('/') + 1, rest.size())));
  if (kind != "package" && kind != "model") return {};
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos || slash == 0) return {};
  const fs::path inside = rest.substr(slash + 1);
  for (const fs::path& package : packages(rest.substr(0, slash))) {
    if (const fs::path file = present(package / inside); !file.empty()) return file;
  }
  return {};
}

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

std::vector<Visual> read_collisions(const ArmDescription& arm, const std::filesystem::path& file) {
  TiXmlDocument document;
  document.Parse(arm.urdf.c_str());  // parsed once already, when the arm was made of it
  const TiXmlElement* const robot = document.RootElement();
  if (robot == nullptr) return {};
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
