#include "devices/files/scene/body_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/touch/mass_properties.h"
#include "devices/files/rpy.h"
#include "devices/files/scene/material_keys.h"
#include "devices/files/scene/scene_reading.h"
#include "devices/files/text_file.h"

namespace limpid {
namespace {

using namespace scene_limits;
using Kind = BodyJoint::Kind;

struct KindName {
  Kind kind;
  const char* name;
};
constexpr std::array kKinds{KindName{Kind::slider, "slider"}, KindName{Kind::hinge, "hinge"},
                            KindName{Kind::ball, "ball"}};

const char* name_of(Kind kind) { return std::ranges::find(kKinds, kind, &KindName::kind)->name; }

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
      t.refuse("travel", "[travel, force] each, every travel further than the one before");
    }
  }
  if (points->empty()) t.refuse("travel", "[travel, force] each, at least one of them");
  return *points;
}

void read_force(const TomlTable& t, JointForce& force) {
  force.spring = t.number("spring", kJointSpring).value_or(force.spring);
  force.rest = t.number("rest", kTravel).value_or(force.rest);
  force.travel = travel_of(t);
  if (const auto detent = t.table("detent")) {
    detent->allow_only({"force", "period"});
    force.detent_force = detent->need(detent->number("force", kJointForce), "force");
    force.detent_period = detent->need(detent->number("period", kPeriod), "period");
  }
}

void read_limits(const TomlTable& t, BodyJoint& joint) {
  if (const auto limits = t.numbers("limits", 2, kEndless)) {
    joint.low = (*limits)[0];
    joint.high = (*limits)[1];
    if (!(joint.low < joint.high)) t.refuse("limits", "[from, to], the first less than the second");
  }
  joint.stop_stiffness = t.number("stop_stiffness", kStiffness).value_or(joint.stop_stiffness);
  joint.stop_restitution = t.number("stop_restitution", kFriction).value_or(joint.stop_restitution);
}

Kind kind_of(const TomlTable& t) {
  const std::string wanted = t.need(t.text("kind"), "kind");
  for (const KindName& each : kKinds) {
    if (each.name == wanted) return each.kind;
  }
  t.refuse("kind", "\"slider\", \"hinge\", \"ball\"");
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
  joint.kind = kind_of(t);
  std::vector<const char*> keys{"kind", "to", "damping", "friction"};
  if (joint.kind != Kind::slider) keys.push_back("point");
  if (joint.kind != Kind::ball) {
    keys.insert(keys.end(), {"axis", "limits", "stop_stiffness", "stop_restitution", "spring",
                             "rest", "detent", "travel"});
  }
  t.allow_only(keys);
  joint.to = t.text("to").value_or("");
  joint.point = place_of(t, "point");
  joint.damping = t.number("damping", kDamping).value_or(joint.damping);
  joint.friction = t.number("friction", kJointForce).value_or(joint.friction);
  if (joint.kind == Kind::ball) return joint;
  joint.axis = axis_of(t);
  read_limits(t, joint);
  read_force(t, joint.force);
  return joint;
}

std::string mass_text(double mass) {
  return fmt::format("a density that makes a mass from {} up to {} kg, not {:.3g} kg",
                     kMass.minimum, kMass.maximum, mass);
}

bool within(double mass) { return mass >= kMass.minimum && mass <= kMass.maximum; }

// Reads mass or density. A mesh has no volume until it is built: its density is kept until then.
void read_mass(const TomlTable& t, Object& object, SceneDocument& out) {
  const auto density = t.number("density", kDensity);
  const auto mass = t.number("mass", kMass);
  if (mass && density) t.refuse_as("density", "density beside mass", "one of them");
  if (!mass && !density) t.refuse_missing("mass (or density)");
  object.body->mass = mass.value_or(object.body->mass);
  if (!density) return;
  if (has_shape<Mesh>(object)) {
    out.densities[object.name] = *density;
    return;
  }
  object.body->mass = *density * volume(object);
  if (!within(object.body->mass)) t.refuse("density", mass_text(object.body->mass));
}

void allow_keys(const TomlTable& t, bool mesh) {
  std::vector<const char*> keys{"name", "box", "sphere", "cylinder", "capsule", "file"};
  if (mesh) {
    keys.insert(keys.end(), {"scale", "unit", "up"});
  } else {
    keys.emplace_back("color");
  }
  keys.insert(keys.end(), {"mass", "density", "center", "inertia", "position", "rotation"});
  for (const MaterialKey& each : kMaterialKeys) keys.push_back(each.key);
  keys.insert(keys.end(), {"contact_stiffness", "restitution", "magnet", "part", "joint"});
  t.allow_only(keys);
}

Object body_of(const TomlTable& t, SceneDocument& out) {
  allow_keys(t, t.find("file") != nullptr);
  Object object{.name = name_of(t), .shape = shape_of(t, true), .body = Body{}};
  if (object.name.empty()) t.refuse("name", "text that is not empty");
  Body& body = *object.body;
  object.pose = pose_of(t, point_of(t, "position"), "rotation");
  object.material = material_of(t, false);
  for (const TomlTable& each : t.tables("part")) object.parts.push_back(part(each));
  read_mass(t, object, out);
  body.center = t.vector("center", kPosition);
  body.inertia = t.vector("inertia", kInertia);
  body.contact_stiffness =
      t.number("contact_stiffness", kStiffness).value_or(body.contact_stiffness);
  body.restitution = t.number("restitution", kFriction).value_or(body.restitution);
  body.magnet = t.flag("magnet").value_or(body.magnet);
  object.color = t.vector("color", kColor);
  if (const auto joint = t.table("joint")) body.joint = joint_of(*joint);
  return object;
}

std::string bodies_text(const std::vector<std::string>& names) {
  return names.empty() ? "a body; there is none"
                       : fmt::format("the name of a body: {}", fmt::join(names, ", "));
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
      tables[i].table("joint")->refuse("to", "a body that does not hang on this one");
    }
  }
}

BodySpring spring_of(const TomlTable& t, const std::vector<std::string>& names) {
  t.allow_only({"between", "points", "length", "stiffness", "damping", "breaks_at"});
  BodySpring spring;
  const std::vector<std::string> between = t.texts("between");
  if (t.find("between") == nullptr) t.refuse_missing("between");
  if (between.empty() || between.size() > 2) t.refuse("between", "one or two names of bodies");
  std::ranges::copy(between, spring.between.begin());
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string& name = spring.between[i];
    if (i == 1 && name.empty()) continue;
    if (std::ranges::find(names, name) == names.end()) t.refuse("between", bodies_text(names));
  }
  if (spring.between[0] == spring.between[1]) t.refuse("between", "two bodies, not one twice");
  if (const auto points = t.vectors("points", kPosition)) {
    if (points->size() != 2) t.refuse("points", "a list of 2, each [x, y, z]");
    std::ranges::copy(*points, spring.points.begin());
  }
  spring.length = t.number("length", kSpringLength).value_or(spring.length);
  spring.stiffness = t.number("stiffness", kJointSpring).value_or(spring.stiffness);
  spring.damping = t.number("damping", kDamping).value_or(spring.damping);
  spring.breaks_at = t.number("breaks_at", kBreaking).value_or(spring.breaks_at);
  return spring;
}

// Writes a value unless it is the usual one.
void put_unless(SceneText& text, const char* key, double value, double usual) {
  if (value != usual) text.put(key, value);
}
void put_unless(SceneText& text, const char* key, const Vec3& value) {
  if (value != Vec3::Zero()) text.put(key, value);
}

void put_shape(SceneText& text, const Shape& shape) {
  const auto tube = [](const auto& s) { return toml_numbers(std::array{s.radius, s.length}); };
  if (const auto* box = std::get_if<Box>(&shape)) text.put("box", box->size);
  if (const auto* ball = std::get_if<Sphere>(&shape)) text.put("sphere", ball->radius);
  if (const auto* c = std::get_if<Cylinder>(&shape)) text.put_raw("cylinder", tube(*c));
  if (const auto* c = std::get_if<Capsule>(&shape)) text.put_raw("capsule", tube(*c));
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    put_model(text, *mesh);
    put_unless(text, "scale", mesh->scale, 1);
  }
}

void put_joint(SceneText& text, const BodyJoint& joint) {
  const BodyJoint usual;
  text.only_table("body.joint");
  text.put("kind", std::string(name_of(joint.kind)));
  if (!joint.to.empty()) text.put("to", joint.to);
  if (joint.kind != Kind::ball) text.put("axis", joint.axis);
  if (joint.kind != Kind::slider) put_unless(text, "point", joint.point);
  put_unless(text, "damping", joint.damping, 0);
  put_unless(text, "friction", joint.friction, 0);
  if (joint.kind == Kind::ball) return;
  if (joint.low != usual.low || joint.high != usual.high) {
    text.put_raw("limits", toml_numbers(std::array{joint.low, joint.high}));
  }
  put_unless(text, "stop_stiffness", joint.stop_stiffness, usual.stop_stiffness);
  put_unless(text, "stop_restitution", joint.stop_restitution, usual.stop_restitution);
  const JointForce& force = joint.force;
  put_unless(text, "spring", force.spring, 0);
  put_unless(text, "rest", force.rest, 0);
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
  if (body.center) text.put("center", *body.center);
  if (body.inertia) text.put("inertia", *body.inertia);
  text.put_position("position", object.pose);
  text.put_rotation(object.pose, "rotation");
  put_material(text, object.material);
  if (object.color) text.put("color", *object.color);
  put_unless(text, "contact_stiffness", body.contact_stiffness, Body{}.contact_stiffness);
  put_unless(text, "restitution", body.restitution, 0);
  if (body.magnet) text.put("magnet", true);
  for (const BodyPart& part : object.parts) {
    text.table("body.part");
    put_shape(text, part.shape);
    put_unless(text, "position", part.pose.translation());
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
  put_unless(text, "length", spring.length, 0);
  text.put("stiffness", spring.stiffness);
  put_unless(text, "damping", spring.damping, 0);
  put_unless(text, "breaks_at", spring.breaks_at, usual.breaks_at);
}

void hold_in(double& x, const Range& range, double otherwise) { x = range.hold(x, otherwise); }
void hold_in(Vec3& v, const Range& range) {
  for (double& x : v) hold_in(x, range, 0);
}

void hold_shape(Shape& shape) {
  const auto tube = [](auto& s) {
    hold_in(s.radius, kLength, 0.02);
    hold_in(s.length, kLength, 0.05);
  };
  if (auto* c = std::get_if<Cylinder>(&shape)) tube(*c);
  if (auto* c = std::get_if<Capsule>(&shape)) tube(*c);
  if (auto* ball = std::get_if<Sphere>(&shape)) hold_in(ball->radius, kLength, 0.02);
  if (auto* box = std::get_if<Box>(&shape)) {
    for (double& edge : box->size) hold_in(edge, kLength, 0.02);
  }
}

void hold_force(JointForce& force) {
  const JointForce usual;
  hold_in(force.spring, kJointSpring, usual.spring);
  hold_in(force.rest, kTravel, usual.rest);
  hold_in(force.detent_force, kJointForce, usual.detent_force);
  hold_in(force.detent_period, kPeriod, usual.detent_period);
  for (auto& [s, F] : force.travel) {
    hold_in(s, kTravelPoint, 0);
    hold_in(F, kTravelPoint, 0);
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
  hold_in(joint.point, kPosition);
  hold_in(joint.damping, kDamping, 0);
  hold_in(joint.friction, kJointForce, 0);
  if (!(joint.low < joint.high)) {
    joint.low = usual.low;
    joint.high = usual.high;
  }
  hold_in(joint.stop_stiffness, kStiffness, usual.stop_stiffness);
  hold_in(joint.stop_restitution, kFriction, 0);
  hold_force(joint.force);
  // A file cannot say what a kind of joint does not have.
  if (joint.kind == Kind::slider) joint.point = usual.point;
  if (joint.kind == Kind::ball) {
    BodyJoint ball;
    ball.kind = joint.kind;
    ball.to = joint.to;
    ball.point = joint.point;
    ball.damping = joint.damping;
    ball.friction = joint.friction;
    joint = ball;
  }
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
    if (!within(object.body->mass)) {
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
    for (double& x : part.pose.translation()) hold_in(x, kPosition, 0);
    const Mat3 R = part.pose.linear();
    part.pose.linear() = R.allFinite() ? settled(R) : Mat3::Identity();
    hold_shape(part.shape);
    if (part.color) hold_in(*part.color, kColor);
  }
  Body& body = *object.body;
  const Body usual;
  hold_in(body.mass, kMass, usual.mass);
  if (body.center) hold_in(*body.center, kPosition);
  if (body.inertia) {
    for (double& x : *body.inertia) hold_in(x, kInertia, 1e-6);
  }
  hold_in(body.contact_stiffness, kStiffness, usual.contact_stiffness);
  hold_in(body.restitution, kFriction, usual.restitution);
  if (body.joint) hold_joint(*body.joint);
}

void hold(BodySpring& spring) {
  const BodySpring usual;
  for (Vec3& point : spring.points) hold_in(point, kPosition);
  hold_in(spring.length, kSpringLength, usual.length);
  hold_in(spring.stiffness, kJointSpring, usual.stiffness);
  hold_in(spring.damping, kDamping, usual.damping);
  hold_in(spring.breaks_at, kBreaking, usual.breaks_at);
}

}  // namespace limpid
