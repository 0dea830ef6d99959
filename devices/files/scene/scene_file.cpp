#include "devices/files/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "devices/files/rpy.h"
#include "devices/files/scene/material_keys.h"
#include "devices/files/scene/model_units.h"
#include "devices/files/scene/scene_limits.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestScene = 1 << 20;  // [bytes]
using namespace scene_limits;

Pose pose(const TomlTable& t, const Vec3& position) {
  Pose p = Pose::Identity();
  p.translation() = position;
  if (const auto rpy = t.vector("rpy", kAngle)) p.linear() = rotation(*rpy);
  return p;
}

Vec3 point(const TomlTable& t, const char* key) { return t.need(t.vector(key, kPosition), key); }
// These keys and those of a material.
void allow_with_material(const TomlTable& t, std::vector<const char*> keys) {
  for (const MaterialKey& each : kMaterialKeys) keys.push_back(each.key);
  t.allow_only(keys);
}

Material material(const TomlTable& t) {
  Material out;
  for (const MaterialKey& each : kMaterialKeys) {
    const auto value = t.number(each.key, each.range);
    out.*each.field = each.required ? t.need(value, each.key) : value.value_or(out.*each.field);
  }
  return out;
}
std::string name(const TomlTable& t) { return t.need(t.text("name"), "name"); }

Plane plane(const TomlTable& t) {
  allow_with_material(t, {"name", "point", "normal"});
  const Vec3 normal = t.need(t.vector("normal", kDirection), "normal");
  if (!(normal.norm() > 1e-9)) t.refuse("normal", "a direction, not zero");
  // One that is unit already stays as it is: what was written is read back to the last bit.
  const bool unit = std::abs(normal.squaredNorm() - 1) < 1e-15;
  return {name(t), point(t, "point"), unit ? normal : normal.normalized(), material(t)};
}

Sphere sphere(const TomlTable& t) {
  allow_with_material(t, {"name", "center", "radius"});
  return {name(t), point(t, "center"), t.need(t.number("radius", kLength), "radius"), material(t)};
}

Box box(const TomlTable& t) {
  allow_with_material(t, {"name", "center", "size", "rpy"});
  return {name(t), pose(t, point(t, "center")), t.need(t.vector("size", kLength), "size"),
          material(t)};
}

int joint_index(const TomlTable& t, const ArmDescription& arm) {
  std::vector<std::string> names;
  for (const Joint& joint : arm.joints) names.push_back(joint.name);
  const std::string allowed =
      fmt::format("{}, or a number from 1 to {}", fmt::join(names, ", "), arm.dof());
  const toml::node* node = t.find("joint");
  if (node == nullptr) t.refuse_missing("joint");
  if (const auto wanted = node->value_exact<std::string>()) {
    for (int i = 0; i < arm.dof(); ++i) {
      if (arm.joints[static_cast<std::size_t>(i)].name == *wanted) return i;
    }
  }
  const auto number = node->value_exact<std::int64_t>();
  if (!number || *number < 1 || *number > arm.dof()) t.refuse("joint", allowed);
  return static_cast<int>(*number) - 1;
}

JointContact joint_contact(const TomlTable& t, const ArmDescription& arm) {
  t.allow_only({"name", "joint", "angle", "side", "stiffness"});
  const std::string side = t.need(t.text("side"), "side");
  if (side != "above" && side != "below") t.refuse("side", "\"above\", \"below\"");
  return {name(t), joint_index(t, arm), t.need(t.number("angle", kAngle), "angle"),
          side == "above" ? 1.0 : -1.0,
          t.need(t.number("stiffness", kJointStiffness), "stiffness")};
}

// Links of the file that were merged into a moving one will do: the ends are moved along.
const NamedFrame& frame(const TomlTable& t, const ArmDescription& arm) {
  const std::string wanted = t.need(t.text("link"), "link");
  std::vector<std::string> names;
  for (const NamedFrame& each : arm.frames) {
    if (each.link < 0) continue;
    if (each.name == wanted) return each;
    names.push_back(each.name);
  }
  t.refuse("link", fmt::format("a link that moves: {}", fmt::join(names, ", ")));
}

Probe probe(const TomlTable& t, const ArmDescription& arm) {
  t.allow_only({"name", "link", "from", "to", "radius"});
  const NamedFrame& at = frame(t, arm);
  const Vec3 from = point(t, "from");
  const Vec3 to = t.vector("to", kPosition).value_or(from);
  return {name(t), at.link, at.origin * from, at.origin * to,
          t.need(t.number("radius", kRadius), "radius")};
}

std::string model_file(const TomlTable& t) {
  const std::string file = t.need(t.text("file"), "file");
  constexpr std::array kKinds{".glb", ".gltf", ".stl", ".obj", ".ply", ".dae"};
  if (std::ranges::find(kKinds, small_suffix(file)) == kKinds.end()) {
    t.refuse("file", fmt::format("a model ({})", fmt::join(kKinds, ", ")));
  }
  return file;
}

fs::path model_path(const TomlTable& t, const std::string& file, const fs::path& base_dir) {
  const fs::path absolute = fs::absolute(base_dir / file).lexically_normal();
  std::error_code error;
  if (const std::string why = why_not_found(absolute, ""); !why.empty()) {
    throw FileError(fmt::format("{}: {}", absolute.string(), why));
  }
  if (!fs::is_regular_file(absolute, error)) {
    t.refuse("file", fmt::format("a file that exists; there is no {}", absolute.string()));
  }
  return absolute;
}

Pose optional_pose(const TomlTable& t) {
  return pose(t, t.vector("position", kPosition).value_or(Vec3::Zero()));
}

ModelFile read_model(const TomlTable& t, const std::string& file, const fs::path& base_dir) {
  const fs::path path = model_path(t, file, base_dir);
  const std::string bytes = read_text(path, kLargestModel);
  return {path.string(),
          std::make_shared<const std::vector<unsigned char>>(bytes.begin(), bytes.end())};
}

double unit(const TomlTable& t, const std::string& file) {
  const auto wanted = t.text("unit");
  if (!wanted) return usual_unit(file);
  std::vector<std::string> names;
  for (const ModelUnit& each : kModelUnits) {
    if (each.name == *wanted) return each.metres;
    names.push_back(fmt::format("\"{}\"", each.name));
  }
  t.refuse("unit", fmt::format("{}", fmt::join(names, ", ")));
}

MeshObstacle mesh(const TomlTable& t) {
  allow_with_material(t, {"name", "file", "position", "rpy", "scale", "unit", "up"});
  MeshObstacle out;
  out.name = name(t);
  out.model = model_file(t);
  out.pose = optional_pose(t);
  out.scale = t.number("scale", kScale).value_or(1);
  out.unit = unit(t, out.model);
  const std::string up = t.text("up").value_or("z");
  if (up != "y" && up != "z") t.refuse("up", "\"y\", \"z\"");
  out.y_up = up == "y";
  out.material = material(t);
  return out;
}

// False for one that is left out.
bool visual(const TomlTable& t, const fs::path& base_dir, SceneVisual& out) {
  t.allow_only({"file", "position", "rpy", "scale"});
  const fs::path file = model_file(t);
  out.pose = optional_pose(t);
  out.scale = t.number("scale", kScale).value_or(1);
  std::error_code error;
  if (base_dir.empty() && (file.is_relative() || !fs::is_regular_file(file, error))) return false;
  out.file = model_path(t, file, base_dir).string();
  return true;
}

void check_counts(const Scene& scene, const std::string& where) {
  const std::size_t contacts = scene.planes.size() + scene.spheres.size() + scene.boxes.size() +
                               scene.meshes.size() + scene.joint_contacts.size();
  if (contacts > kMostContacts) {
    throw FileError(
        fmt::format("{}: {} planes, spheres, boxes, meshes and joint contacts; at most {}", where,
                    contacts, kMostContacts));
  }
  if (scene.probes.size() + 1 > kMostProbes) {
    throw FileError(fmt::format("{}: {} probes; at most {} besides the tip", where,
                                scene.probes.size(), kMostProbes - 1));
  }
}

}  // namespace

SceneDocument read_scene(const fs::path& file, const ArmDescription& arm) {
  return parse_scene(read_text(file, kLongestScene), file.string(),
                     fs::absolute(file).parent_path(), arm);
}

SceneDocument parse_scene(const std::string& text, const std::string& where,
                          const fs::path& base_dir, const ArmDescription& arm,
                          const SceneFiles& files) {
  const toml::table table = parse_toml(text, where);
  const TomlTable t(table, where, "");
  t.allow_only({"title", "about", "tip_radius", "plane", "sphere", "box", "mesh", "joint_contact",
                "probe", "visual"});
  SceneDocument out;
  out.title = t.text("title").value_or("");
  out.about = t.text("about").value_or("");
  Scene& scene = out.scene;
  scene.tip_radius = t.number("tip_radius", kRadius).value_or(0);
  for (const TomlTable& each : t.tables("plane")) scene.planes.push_back(plane(each));
  for (const TomlTable& each : t.tables("sphere")) scene.spheres.push_back(sphere(each));
  for (const TomlTable& each : t.tables("box")) scene.boxes.push_back(box(each));
  for (const TomlTable& each : t.tables("mesh")) {
    const std::string& model = scene.meshes.emplace_back(mesh(each)).model;
    if (out.models.contains(model)) continue;
    const auto known = files.find(model);
    out.models[model] =
        known != files.end() ? ModelFile{"", known->second} : read_model(each, model, base_dir);
  }
  for (const TomlTable& each : t.tables("joint_contact")) {
    scene.joint_contacts.push_back(joint_contact(each, arm));
  }
  for (const TomlTable& each : t.tables("probe")) scene.probes.push_back(probe(each, arm));
  for (const TomlTable& each : t.tables("visual")) {
    SceneVisual seen;
    if (visual(each, base_dir, seen)) out.visuals.push_back(std::move(seen));
  }
  check_counts(scene, where);
  out.toml = text;
  return out;
}

}  // namespace limpid
