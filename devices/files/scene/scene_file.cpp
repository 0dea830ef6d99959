#include "devices/files/scene/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "devices/files/field_file.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/body_file.h"
#include "devices/files/scene/scene_document.h"
#include "devices/files/scene/scene_fields.h"
#include "devices/files/scene/scene_reading.h"
#include "devices/files/scene/scene_text.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestScene = 1 << 20;  // [bytes]
using namespace scene_limits;

Pose optional_pose(const TomlTable& t) {
  return pose_of(t, t.vector("position", kPosition).value_or(Vec3::Zero()), "rpy");
}

// Names of a shape in files: of its table, and of the keys of its place.
struct Form {
  const char* table;
  const char* position;
  const char* rotation;  // null: it cannot be turned
};
Form form_of(const Plane&) { return {"plane", "point", nullptr}; }
Form form_of(const Sphere&) { return {"sphere", "center", nullptr}; }
Form form_of(const Box&) { return {"box", "center", "rpy"}; }
Form form_of(const Cylinder&) { return {"cylinder", "position", "rotation"}; }
Form form_of(const Capsule&) { return {"capsule", "position", "rotation"}; }
Form form_of(const Mesh&) { return {"mesh", "position", "rpy"}; }
Form form_of(const JointStop&) { return {"joint_contact", nullptr, nullptr}; }

bool has_color(const Object& object) {
  return !has_shape<Plane>(object) && !has_shape<Mesh>(object) && !has_shape<JointStop>(object);
}

// Forms of each shape in files, without name, place and material: read_own() reads what is not
// among its fields, write_own() writes it, hold_own() keeps it within limits.
template <class S>
void read_own(const TomlTable&, S&) {}
template <class S>
void write_own(const S&, SceneText&) {}
template <class S>
void hold_own(Object&, S&) {}

void read_own(const TomlTable& t, Plane& plane) {
  plane.normal = t.need(t.vector("normal", kDirection), "normal");
  if (!(plane.normal.norm() > 1e-9)) t.refuse("normal", "a direction, not zero");
  // A unit vector stays as it is, so that a written one is read back to the last bit.
  if (!(std::abs(plane.normal.squaredNorm() - 1) < 1e-15)) plane.normal.normalize();
}
void write_own(const Plane& plane, SceneText& text) { text.put("normal", plane.normal); }
void hold_own(Object& object, Plane& plane) {
  object.pose.linear().setIdentity();
  const double length = plane.normal.stableNorm();
  const bool direction = std::isfinite(length) && length > 1e-9;
  plane.normal = direction ? Vec3(plane.normal / length) : Vec3(Vec3::UnitZ());
}

void hold_own(Object& object, Sphere&) {
  if (!object.body) object.pose.linear().setIdentity();
}

void read_own(const TomlTable& t, Mesh& mesh) { read_model_keys(t, mesh); }
void write_own(const Mesh& mesh, SceneText& text) { put_model(text, mesh); }
void hold_own(Object&, Mesh& mesh) {
  if (model_unit(mesh.unit) == nullptr) mesh.unit = 1;
}

template <class S>
void read(const TomlTable& t, const ArmDescription&, Object& object, S& shape) {
  const Form form = form_of(shape);
  std::vector<const char*> keys{"name", form.position};
  if (form.rotation != nullptr) keys.push_back(form.rotation);
  if constexpr (std::is_same_v<S, Plane>) keys.emplace_back("normal");
  if constexpr (std::is_same_v<S, Mesh>) keys.insert(keys.end(), {"file", "unit", "up"});
  if (has_color(object)) keys.emplace_back("color");
  add_keys(fields_of(shape), shape, keys);
  add_keys(kMaterialFields, object.material, keys);
  t.allow_only(keys);
  object.color = t.vector("color", kColor);
  const auto place = t.vector(form.position, kPosition);
  if (!place && !has_shape<Mesh>(object)) t.refuse_missing(form.position);
  object.pose = pose_at(place.value_or(Vec3::Zero()));
  if (form.rotation != nullptr) object.pose = pose_of(t, object.pose.translation(), form.rotation);
  read_fields(t, fields_of(shape), shape);
  read_own(t, shape);
  read_fields(t, kMaterialFields, object.material);
}

template <class S>
void write(const Object& object, const S& shape, const ArmDescription&, SceneText& text) {
  const Form form = form_of(shape);
  write_own(shape, text);
  put_fields(text, fields_of(shape), shape);
  if (!has_shape<Mesh>(object) || !object.pose.translation().isZero(0)) {
    text.put_position(form.position, object.pose);
  }
  if (form.rotation != nullptr) text.put_rotation(object.pose, form.rotation);
  put_fields(text, kMaterialFields, object.material);
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

void read(const TomlTable& t, const ArmDescription& arm, Object& object, JointStop& stop) {
  std::vector<const char*> keys{"name", "joint", kStopStiffness.key};
  add_keys(kJointStopFields, stop, keys);
  t.allow_only(keys);
  stop.joint = joint_index(t, arm);
  read_fields(t, kJointStopFields, stop);
  read_field(t, kStopStiffness, object.material, true);
}

void put_joint(SceneText& text, const JointStop& stop, const ArmDescription& arm) {
  const auto named = [&](const Joint& joint) {
    return joint.name == arm.joints[static_cast<std::size_t>(stop.joint)].name;
  };
  const auto first = std::find_if(arm.joints.begin(), arm.joints.end(), named);
  if (std::distance(arm.joints.begin(), first) == stop.joint) {
    text.put("joint", first->name);
  } else {
    text.put("joint", std::int64_t{stop.joint} + 1);
  }
}

void write(const Object& object, const JointStop& stop, const ArmDescription& arm,
           SceneText& text) {
  put_joint(text, stop, arm);
  put_fields(text, kJointStopFields, stop);
  put_fields(text, std::array{kStopStiffness}, object.material);
}

void hold_own(Object& object, JointStop& stop) {
  stop.direction = stop.direction < 0 ? -1 : 1;
  object.pose.setIdentity();
  double& stiffness = object.material.stiffness;
  stiffness = kStopStiffness.hold(stiffness, JointStop::kUsualStiffness);
}

// A shape of each kind, in the order of files.
template <std::size_t... I>
std::array<Shape, sizeof...(I)> every_shape(std::index_sequence<I...>) {
  return {Shape(std::in_place_index<I>)...};
}
const auto kShapesOfFiles = every_shape(std::make_index_sequence<std::variant_size_v<Shape>>());

const char* table_of(const Shape& shape) {
  return std::visit([](const auto& s) { return form_of(s).table; }, shape);
}

void read_objects(const TomlTable& t, const ArmDescription& arm, const fs::path& base_dir,
                  const SceneFiles& files, SceneDocument& out) {
  for (const Shape& shape : kShapesOfFiles) {
    for (const TomlTable& each : t.tables(table_of(shape))) {
      Object& object = out.scene.objects.emplace_back(Object{.shape = shape});
      std::visit([&](auto& s) { read(each, arm, object, s); }, object.shape);
      object.name = name_of(each);
      const auto* mesh = std::get_if<Mesh>(&object.shape);
      if (mesh != nullptr) take_model(each, *mesh, base_dir, files, out);
    }
  }
}

// The named frame of a link that moves. Links of the file that were merged into a moving one count,
// too; the probe's ends move along.
const NamedFrame& named_frame(const TomlTable& t, const ArmDescription& arm) {
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
  const NamedFrame& at = named_frame(t, arm);
  const Vec3 from = point_of(t, "from");
  const Vec3 to = t.vector("to", kPosition).value_or(from);
  return {name_of(t), at.link, at.origin * from, at.origin * to,
          t.need(t.number("radius", kRadius), "radius")};
}

// The frame in which a probe's ends are written: the link's own if the file has a name for it.
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

void put_probe(SceneText& text, const Probe& probe, const ArmDescription& arm) {
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

// Reads a visual; false if it is left out.
bool visual(const TomlTable& t, const fs::path& base_dir, SceneVisual& out) {
  t.allow_only({"file", "position", "rpy", "scale"});
  const fs::path file = model_of(t);
  out.pose = optional_pose(t);
  out.scale = t.number("scale", kScale).value_or(1);
  std::error_code error;
  if (base_dir.empty() && (file.is_relative() || !fs::is_regular_file(file, error))) return false;
  out.file = model_path(t, file, base_dir).string();
  return true;
}

std::string relative(const std::string& file, const fs::path& folder) {
  if (folder.empty()) return file;
  const fs::path inside = fs::path(file).lexically_relative(folder.lexically_normal());
  return inside.empty() || *inside.begin() == ".." ? file : inside.string();
}

void check_counts(const Scene& scene, const std::string& where) {
  const std::size_t contacts = scene.objects.size();
  if (contacts > kMostContacts) {
    throw FileError(
        fmt::format("{}: {} objects to touch; at most {}", where, contacts, kMostContacts));
  }
  if (scene.probes.size() + 1 > kMostProbes) {
    throw FileError(fmt::format("{}: {} probes; at most {} in addition to the tip", where,
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
  std::vector<const char*> keys{"title", "about", "tip_radius"};
  for (const Shape& shape : kShapesOfFiles) keys.push_back(table_of(shape));
  keys.insert(keys.end(), {"gravity", "body", "spring", "probe", "visual"});
  t.allow_only(keys);
  SceneDocument out;
  out.title = t.text("title").value_or("");
  out.about = t.text("about").value_or("");
  Scene& scene = out.scene;
  scene.tip_radius = t.number("tip_radius", kRadius).value_or(0);
  read_objects(t, arm, base_dir, files, out);
  read_bodies(t, base_dir, files, out);
  for (const TomlTable& each : t.tables("probe")) scene.probes.push_back(probe(each, arm));
  for (const TomlTable& each : t.tables("visual")) {
    SceneVisual seen;
    if (visual(each, base_dir, seen)) out.visuals.push_back(std::move(seen));
  }
  check_counts(scene, where);
  out.toml = text;
  return out;
}

void hold(Object& object) {
  for (double& x : object.pose.translation()) x = kPosition.hold(x, 0);
  const Mat3 R = object.pose.linear();
  object.pose.linear() = R.allFinite() ? settled(R) : Mat3::Identity();
  if (has_surface(object)) hold_fields(kMaterialFields, object.material);
  if (!has_color(object)) object.color.reset();
  hold_color(object.color);
  hold_size(object.shape);
  std::visit([&](auto& shape) { hold_own(object, shape); }, object.shape);
  hold_body(object);
}

std::string scene_text(const SceneDocument& document, const ArmDescription& arm,
                       const fs::path& folder) {
  const Scene& scene = document.scene;
  SceneText text;
  if (!document.title.empty()) text.put("title", document.title);
  if (!document.about.empty()) text.put("about", document.about);
  if (scene.tip_radius != 0) text.put("tip_radius", scene.tip_radius);
  put_gravity(text, scene);
  for (const Object& object : scene.objects) {
    if (object.body) continue;
    text.table(table_of(object.shape));
    text.put("name", object.name);
    std::visit([&](const auto& shape) { write(object, shape, arm, text); }, object.shape);
    if (object.color) text.put("color", *object.color);
  }
  put_bodies(text, document);
  for (const Probe& probe : scene.probes) put_probe(text, probe, arm);
  for (const SceneVisual& visual : document.visuals) {
    text.table("visual");
    text.put("file", relative(visual.file, folder));
    text.put_place(visual.pose, visual.scale);
  }
  return text.text();
}

}  // namespace limpid
