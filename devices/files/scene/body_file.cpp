#include "devices/files/scene/body_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/touch/mass_properties.h"
#include "devices/files/field_file.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/scene_fields.h"
#include "devices/files/scene/scene_reading.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

using namespace scene_limits;
// Keys of shapes; a body and each of its parts has one of them.
constexpr std::array kShapeKeys{"box", "sphere", "cylinder", "capsule"};

template <class S>
S tube(const TomlTable& t, const char* key) {
  const std::vector<double> list = *t.numbers(key, 2, kLength);
  return {list[0], list[1]};
}

// Reads a shape; `file` is one, too, if `models` allows it.
Shape shape_of(const TomlTable& t, bool models) {
  std::vector<std::string> keys(kShapeKeys.begin(), kShapeKeys.end());
  if (models) keys.emplace_back("file");
  std::vector<std::string> found;
  for (const std::string& key : keys) {
    if (t.find(key.c_str()) != nullptr) found.push_back(key);
  }
  const std::string allowed = fmt::format("one of {}", fmt::join(keys, ", "));
  if (found.empty()) t.refuse_missing(fmt::format("shape ({})", allowed).c_str());
  if (found.size() > 1) {
    t.refuse_as(found[1].c_str(), fmt::format("{} beside {}", found[1], found[0]), allowed);
  }
  if (found[0] == "box") return Box{*t.vector("box", kLength)};
  if (found[0] == "sphere") return Sphere{*t.number("sphere", kLength)};
  if (found[0] == "cylinder") return tube<Cylinder>(t, "cylinder");
  if (found[0] == "capsule") return tube<Capsule>(t, "capsule");
  Mesh mesh;
  read_model_keys(t, mesh);
  return mesh;
}

Vec3 place_of(const TomlTable& t, const char* key) {
  return t.vector(key, kPosition).value_or(Vec3::Zero());
}

BodyPart part(const TomlTable& t) {
  std::vector<const char*> keys(kShapeKeys.begin(), kShapeKeys.end());
  keys.insert(keys.end(), {"position", "rotation", "color"});
  t.allow_only(keys);
  return {pose_of(t, place_of(t, "position"), "rotation"), shape_of(t, false),
          t.vector("color", kColor)};
}

// Reads increasing positions, with the force at each.
std::vector<std::array<double, 2>> travel_of(const TomlTable& t) {
  const auto points = t.pairs("travel", kTravelPoint);
  if (!points) return {};
  for (std::size_t i = 1; i < points->size(); ++i) {
    if (!((*points)[i][0] > (*points)[i - 1][0])) {
      t.refuse("travel",
               "a list of [travel, force], with each travel larger than the travel before");
    }
  }
  if (points->empty()) t.refuse("travel", "a list of at least one [travel, force]");
  return *points;
}

void read_force(const TomlTable& t, JointForce& force) {
  read_fields(t, kForceFields, force);
  force.travel = travel_of(t);
  if (const auto detent = t.table("detent")) {
    detent->allow_only({"force", "period"});
    read_fields(*detent, kDetentFields, force);
  }
}

void read_limits(const TomlTable& t, BodyJoint& joint) {
  if (const auto limits = t.numbers("limits", 2, kEndless)) {
    joint.low = (*limits)[0];
    joint.high = (*limits)[1];
    if (!(joint.low < joint.high)) t.refuse("limits", "[from, to], with from less than to");
  }
}

Vec3 axis_of(const TomlTable& t) {
  Vec3 axis = t.need(t.vector("axis", kDirection), "axis");
  if (!(axis.norm() > 1e-9)) t.refuse("axis", "a direction, not zero");
  // A unit vector stays as it is, so that a written one is read back to the last bit.
  if (!(std::abs(axis.squaredNorm() - 1) < 1e-15)) axis.normalize();
  return axis;
}

BodyJoint joint_of(const TomlTable& t) {
  BodyJoint joint;
  read_field(t, kJointFields.front(), joint, true);
  std::vector<const char*> keys;
  add_keys(kJointFields, joint, keys);
  add_keys(kStopFields, joint, keys);
  if (has_axis(joint)) {
    add_keys(kForceFields, joint.force, keys);
    keys.insert(keys.end(), {"axis", "limits", "detent", "travel"});
  }
  t.allow_only(keys);
  read_fields(t, kJointFields, joint);
  read_fields(t, kStopFields, joint);
  if (!has_axis(joint)) return joint;
  joint.axis = axis_of(t);
  read_limits(t, joint);
  read_force(t, joint.force);
  return joint;
}

std::string mass_text(double mass) {
  return fmt::format("a density that gives a mass from {} to {} kg, not {:.3g} kg", kMass.minimum,
                     kMass.maximum, mass);
}

// Reads mass or density. A mesh has no volume until it is built: its density is kept until then.
void read_mass(const TomlTable& t, Object& object, SceneDocument& out) {
  const auto density = t.number("density", kDensity);
  const bool mass = t.find(kBodyMass.key) != nullptr;
  read_field(t, kBodyMass, *object.body, false);
  if (mass && density)
    t.refuse_as("density", "mass or density, not both", "only mass or only density");
  if (!mass && !density) t.refuse_missing("mass (or density)");
  if (!density) return;
  if (has_shape<Mesh>(object)) {
    out.densities[object.name] = *density;
    return;
  }
  object.body->mass = *density * volume(object);
  if (!kMass.holds(object.body->mass)) t.refuse("density", mass_text(object.body->mass));
}

void allow_keys(const TomlTable& t, bool mesh) {
  std::vector<const char*> keys{"name", "box", "sphere", "cylinder", "capsule", "file"};
  if (mesh) {
    keys.insert(keys.end(), {"unit", "up"});
    add_keys(kMeshFields, Mesh{}, keys);
  } else {
    keys.emplace_back("color");
  }
  keys.insert(keys.end(), {kBodyMass.key, "density", "position", "rotation"});
  add_keys(kMaterialFields, Material{}, keys);
  add_keys(kBodyFields, Body{}, keys);
  keys.insert(keys.end(), {"part", "joint"});
  t.allow_only(keys);
}

Object body_of(const TomlTable& t, SceneDocument& out) {
  allow_keys(t, t.find("file") != nullptr);
  Object object{.name = name_of(t), .shape = shape_of(t, true), .body = Body{}};
  if (object.name.empty()) t.refuse("name", "text that is not empty");
  Body& body = *object.body;
  object.pose = pose_of(t, point_of(t, "position"), "rotation");
  read_fields(t, kMaterialFields, object.material, false);
  for (const TomlTable& each : t.tables("part")) object.parts.push_back(part(each));
  read_mass(t, object, out);
  read_fields(t, kBodyFields, body);
  object.color = t.vector("color", kColor);
  if (const auto joint = t.table("joint")) body.joint = joint_of(*joint);
  return object;
}

std::string bodies_text(const std::vector<std::string>& names) {
  return names.empty() ? "the name of a body; the file has no bodies"
                       : fmt::format("one of the bodies {}", fmt::join(names, ", "));
}

void check_joints(const std::vector<TomlTable>& tables, const Scene& scene) {
  const std::vector<std::string> names = body_names(scene);
  const std::size_t first = scene.objects.size() - names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& joint = scene.objects[first + i].body->joint;
    if (!joint || joint->to.empty()) continue;
    if (std::ranges::find(names, joint->to) == names.end()) {
      tables[i].table("joint")->refuse("to", bodies_text(names));
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (joint_leads_round(scene, first + i)) {
      tables[i].table("joint")->refuse("to", "a body whose joints do not lead to this body");
    }
  }
}

BodySpring spring_of(const TomlTable& t, const std::vector<std::string>& names) {
  BodySpring spring;
  std::vector<const char*> keys{"between", "points"};
  add_keys(kSpringFields, spring, keys);
  t.allow_only(keys);
  const std::vector<std::string> between = t.texts("between");
  if (t.find("between") == nullptr) t.refuse_missing("between");
  if (between.empty() || between.size() > 2) t.refuse("between", "one or two names of bodies");
  std::ranges::copy(between, spring.between.begin());
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string& name = spring.between[i];
    if (i == 1 && name.empty()) continue;
    if (std::ranges::find(names, name) == names.end()) t.refuse("between", bodies_text(names));
  }
  if (spring.between[0] == spring.between[1]) t.refuse("between", "two different bodies");
  if (const auto points = t.vectors("points", kPosition)) {
    if (points->size() != 2) t.refuse("points", "a list of 2, each [x, y, z]");
    std::ranges::copy(*points, spring.points.begin());
  }
  read_fields(t, kSpringFields, spring);
  return spring;
}

void put_shape(SceneText& text, const Shape& shape) {
  const auto tube = [](const auto& s) { return toml_numbers(std::array{s.radius, s.length}); };
  if (const auto* box = std::get_if<Box>(&shape)) text.put("box", box->size);
  if (const auto* ball = std::get_if<Sphere>(&shape)) text.put("sphere", ball->radius);
  if (const auto* c = std::get_if<Cylinder>(&shape)) text.put_raw("cylinder", tube(*c));
  if (const auto* c = std::get_if<Capsule>(&shape)) text.put_raw("capsule", tube(*c));
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    put_model(text, *mesh);
    put_fields(text, kMeshFields, *mesh);
  }
  static_assert(kShapes == 7 && kShapeKeys.size() == 4);
}

void put_joint(SceneText& text, const BodyJoint& joint) {
  const BodyJoint usual;
  text.only_table("body.joint");
  put_fields(text, kJointFields, joint);
  if (has_axis(joint)) text.put("axis", joint.axis);
  put_fields(text, kStopFields, joint);
  if (!has_axis(joint)) return;
  if (joint.low != usual.low || joint.high != usual.high) {
    text.put_raw("limits", toml_numbers(std::array{joint.low, joint.high}));
  }
  const JointForce& force = joint.force;
  put_fields(text, kForceFields, force);
  if (force.detent_force != 0 || force.detent_period != JointForce{}.detent_period) {
    text.put_raw("detent",
                 fmt::format("{{ force = {}, period = {} }}", toml_number(force.detent_force),
                             toml_number(force.detent_period)));
  }
  std::vector<std::string> points;
  for (const auto& point : force.travel) points.push_back(toml_numbers(point));
  if (!points.empty()) text.put_raw("travel", fmt::format("[{}]", fmt::join(points, ", ")));
}

void put_body(SceneText& text, const Object& object, const SceneDocument& document) {
  const Body& body = *object.body;
  text.table("body");
  text.put("name", object.name);
  put_shape(text, object.shape);
  const auto density = document.densities.find(object.name);
  if (density != document.densities.end()) {
    text.put("density", density->second);
  } else {
    text.put("mass", body.mass);
  }
  text.put_position("position", object.pose);
  text.put_rotation(object.pose, "rotation");
  put_fields(text, kMaterialFields, object.material);
  if (object.color) text.put("color", *object.color);
  put_fields(text, kBodyFields, body);
  for (const BodyPart& part : object.parts) {
    text.table("body.part");
    put_shape(text, part.shape);
    if (!part.pose.translation().isZero(0)) text.put_position("position", part.pose);
    text.put_rotation(part.pose, "rotation");
    if (part.color) text.put("color", *part.color);
  }
  if (body.joint) put_joint(text, *body.joint);
}

void put_spring(SceneText& text, const BodySpring& spring) {
  const BodySpring usual;
  text.table("spring");
  std::string names = toml_quoted(spring.between[0]);
  if (!spring.between[1].empty()) names += ", " + toml_quoted(spring.between[1]);
  text.put_raw("between", fmt::format("[{}]", names));
  if (spring.points != usual.points) {
    text.put_raw("points", fmt::format("[{}, {}]", toml_vector(spring.points[0]),
                                       toml_vector(spring.points[1])));
  }
  put_fields(text, kSpringFields, spring);
}

void hold_force(JointForce& force) {
  hold_fields(kForceFields, force);
  hold_fields(kDetentFields, force);
  for (auto& point : force.travel) {
    for (double& x : point) x = kTravelPoint.hold(x, 0);
  }
  std::ranges::stable_sort(force.travel, {}, [](const auto& point) { return point[0]; });
  const auto same = std::unique(force.travel.begin(), force.travel.end(),
                                [](const auto& a, const auto& b) { return a[0] == b[0]; });
  force.travel.erase(same, force.travel.end());
}

void hold_joint(BodyJoint& joint) {
  const BodyJoint usual;
  const double length = joint.axis.stableNorm();
  const bool direction = std::isfinite(length) && length > 1e-9;
  if (!direction) joint.axis = usual.axis;
  if (!(std::abs(joint.axis.squaredNorm() - 1) < 1e-15)) joint.axis /= joint.axis.stableNorm();
  hold_fields(kJointFields, joint);
  hold_fields(kStopFields, joint);
  if (!(joint.low < joint.high)) {
    joint.low = usual.low;
    joint.high = usual.high;
  }
  hold_force(joint.force);
  // A file cannot say what a kind of joint does not have.
  if (has_axis(joint)) return;
  joint.axis = usual.axis;
  joint.low = usual.low;
  joint.high = usual.high;
  joint.force = usual.force;
}

}  // namespace

bool joint_leads_round(const Scene& scene, std::size_t place) {
  const std::vector<Object>& objects = scene.objects;
  const Object* at = &objects.at(place);
  for (std::size_t steps = 0; steps <= objects.size(); ++steps) {
    if (!at->body || !at->body->joint || at->body->joint->to.empty()) return false;
    const auto next = std::ranges::find_if(objects, [&](const Object& object) {
      return object.body && object.name == at->body->joint->to;
    });
    if (next == objects.end()) return false;
    at = &*next;
    if (at == &objects[place]) return true;
  }
  return false;
}

void read_bodies(const TomlTable& file, const std::filesystem::path& base_dir,
                 const SceneFiles& files, SceneDocument& out) {
  Scene& scene = out.scene;
  scene.gravity = file.vector("gravity", kGravity).value_or(scene.gravity);
  const std::vector<TomlTable> tables = file.tables("body");
  if (tables.size() > kMostBodies) {
    file.refuse_as("body", fmt::format("{} bodies", tables.size()),
                   fmt::format("at most {}", kMostBodies));
  }
  std::vector<std::string> names;
  for (const TomlTable& each : tables) {
    Object object = body_of(each, out);
    if (std::ranges::find(names, object.name) != names.end()) {
      each.refuse("name", "a name that no other body has");
    }
    names.push_back(object.name);
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      take_model(each, *mesh, base_dir, files, out);
    }
    scene.add(std::move(object));
  }
  check_joints(tables, scene);
  const std::vector<TomlTable> springs = file.tables("spring");
  if (springs.size() > kMostSprings) {
    file.refuse_as("spring", fmt::format("{} springs", springs.size()),
                   fmt::format("at most {}", kMostSprings));
  }
  for (const TomlTable& each : springs) scene.springs.push_back(spring_of(each, names));
}

void put_gravity(SceneText& text, const Scene& scene) {
  if (scene.gravity != Scene{}.gravity) text.put("gravity", scene.gravity);
}

void put_bodies(SceneText& text, const SceneDocument& document) {
  for (const Object& object : document.scene.objects) {
    if (object.body) put_body(text, object, document);
  }
  for (const BodySpring& spring : document.scene.springs) put_spring(text, spring);
}

void settle_masses(SceneDocument& document) {
  for (Object& object : document.scene.objects) {
    const auto density = document.densities.find(object.name);
    if (!object.body || density == document.densities.end()) continue;
    object.body->mass = density->second * volume(object);
    if (!kMass.holds(object.body->mass)) {
      throw FileError(fmt::format("body {}: density: {} is not allowed; allowed: {}", object.name,
                                  density->second, mass_text(object.body->mass)));
    }
  }
  document.densities.clear();
}

void hold_body(Object& object) {
  if (has_shape<Plane>(object) || has_shape<JointStop>(object)) object.body.reset();
  if (!object.body) return;
  for (BodyPart& part : object.parts) {
    for (double& x : part.pose.translation()) x = kPosition.hold(x, 0);
    const Mat3 R = part.pose.linear();
    part.pose.linear() = R.allFinite() ? settled(R) : Mat3::Identity();
    hold_size(part.shape);
    hold_color(part.color);
  }
  Body& body = *object.body;
  body.mass = kBodyMass.hold(body.mass, Body{}.mass);
  hold_fields(kBodyFields, body);
  if (body.joint) hold_joint(*body.joint);
}

void hold(BodySpring& spring) {
  for (Vec3& point : spring.points) {
    for (double& x : point) x = kPosition.hold(x, 0);
  }
  hold_fields(kSpringFields, spring);
}

}  // namespace limpid
