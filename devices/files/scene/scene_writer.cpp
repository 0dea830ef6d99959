#include "devices/files/scene/scene_writer.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/files/rpy.h"
#include "devices/files/scene/material_keys.h"
#include "devices/files/scene/model_units.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

std::string number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".ein") == std::string::npos) text += ".0";
  return text;
}

std::string vector(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += fmt::format("\\u{:04X}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

class Text {
 public:
  void table(const char* kind) {
    text_ += fmt::format("{}[[{}]]\n", text_.empty() ? "" : "\n", kind);
  }
  void put(const char* key, const std::string& value) { line(key, quoted(value)); }
  void put(const char* key, double value) { line(key, number(value)); }
  void put(const char* key, const Vec3& value) { line(key, vector(value)); }
  void put(const char* key, int value) { line(key, std::to_string(value)); }
  void put_rotation(const Pose& pose) {
    if (pose.linear() != Mat3::Identity()) put("rpy", rpy_of(pose.linear()));
  }
  // Of what may be left out.
  void put_place(const Pose& pose, double scale) {
    if (!pose.translation().isZero(0)) put("position", Vec3(pose.translation()));
    put_rotation(pose);
    if (scale != 1) put("scale", scale);
  }
  const std::string& text() const { return text_; }

 private:
  void line(const char* key, const std::string& value) {
    text_ += fmt::format("{} = {}\n", key, value);
  }
  std::string text_;
};

void put_material(Text& text, const Material& material) {
  for (const MaterialKey& each : kMaterialKeys) {
    const double value = material.*each.field;
    if (each.required || value != Material{}.*each.field) text.put(each.key, value);
  }
}

void put_joint(Text& text, const JointContact& contact, const ArmDescription& arm) {
  const auto named = [&](const Joint& joint) {
    return joint.name == arm.joints[static_cast<std::size_t>(contact.joint)].name;
  };
  const auto first = std::find_if(arm.joints.begin(), arm.joints.end(), named);
  if (std::distance(arm.joints.begin(), first) == contact.joint) {
    text.put("joint", first->name);
  } else {
    text.put("joint", contact.joint + 1);
  }
}

// The frame that the ends are written in: the link's own where the file has a name for it.
const NamedFrame& frame(const Probe& probe, const ArmDescription& arm) {
  const NamedFrame* found = nullptr;
  for (const NamedFrame& each : arm.frames) {
    if (each.link != probe.link) continue;
    if (each.origin.matrix() == Pose::Identity().matrix()) return each;
    if (found == nullptr) found = &each;
  }
  if (found != nullptr) return *found;
  throw FileError(fmt::format("probe {}: its link has no name", probe.name));
}

void put_probe(Text& text, const Probe& probe, const ArmDescription& arm) {
  const NamedFrame& at = frame(probe, arm);
  const bool own = at.origin.matrix() == Pose::Identity().matrix();
  const Pose back = own ? Pose::Identity() : at.origin.inverse();
  text.table("probe");
  text.put("name", probe.name);
  text.put("link", at.name);
  text.put("from", Vec3(back * probe.from));
  if (probe.to != probe.from) text.put("to", Vec3(back * probe.to));
  text.put("radius", probe.radius);
}

std::string relative(const std::string& file, const fs::path& folder) {
  if (folder.empty()) return file;
  const fs::path inside = fs::path(file).lexically_relative(folder.lexically_normal());
  return inside.empty() || *inside.begin() == ".." ? file : inside.string();
}

}  // namespace

std::string scene_text(const SceneDocument& document, const ArmDescription& arm,
                       const fs::path& folder) {
  const Scene& scene = document.scene;
  Text text;
  if (!document.title.empty()) text.put("title", document.title);
  if (!document.about.empty()) text.put("about", document.about);
  if (scene.tip_radius != 0) text.put("tip_radius", scene.tip_radius);
  for (const Plane& plane : scene.planes) {
    text.table("plane");
    text.put("name", plane.name);
    text.put("point", plane.point);
    text.put("normal", plane.normal);
    put_material(text, plane.material);
  }
  for (const Sphere& sphere : scene.spheres) {
    text.table("sphere");
    text.put("name", sphere.name);
    text.put("center", sphere.center);
    text.put("radius", sphere.radius);
    put_material(text, sphere.material);
  }
  for (const Box& box : scene.boxes) {
    text.table("box");
    text.put("name", box.name);
    text.put("center", Vec3(box.pose.translation()));
    text.put("size", box.size);
    text.put_rotation(box.pose);
    put_material(text, box.material);
  }
  for (const MeshObstacle& mesh : scene.meshes) {
    text.table("mesh");
    text.put("name", mesh.name);
    text.put("file", mesh.model);
    text.put_place(mesh.pose, mesh.scale);
    const ModelUnit* const unit = model_unit(mesh.unit);
    if (unit && mesh.unit != usual_unit(mesh.model)) text.put("unit", std::string(unit->name));
    if (mesh.y_up) text.put("up", std::string("y"));
    put_material(text, mesh.material);
  }
  for (const JointContact& contact : scene.joint_contacts) {
    text.table("joint_contact");
    text.put("name", contact.name);
    put_joint(text, contact, arm);
    text.put("angle", contact.angle);
    text.put("side", std::string(contact.direction > 0 ? "above" : "below"));
    text.put("stiffness", contact.stiffness);
  }
  for (const Probe& probe : scene.probes) put_probe(text, probe, arm);
  for (const SceneVisual& visual : document.visuals) {
    text.table("visual");
    text.put("file", relative(visual.file, folder));
    text.put_place(visual.pose, visual.scale);
  }
  return text.text();
}

}  // namespace limpid
