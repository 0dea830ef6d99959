#include "app/sweep/body_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "devices/files/scene/scene_fields.h"

namespace limpid {

namespace {

// Sets the mass by the density: moments, if given, scale with it.
void set_mass(Object& object, double mass) {
  Body& body = *object.body;
  if (body.inertia) *body.inertia *= mass / body.mass;
  body.mass = mass;
}

void set_friction(Object& object, double x) {
  object.material.friction_static = object.material.friction_kinetic = x;
}

bool on_joint(const Object& object) { return object.body->joint.has_value(); }
bool on_axis(const Object& object) { return on_joint(object) && has_axis(*object.body->joint); }

std::vector<BodyProperty> all_properties() {
  const auto every = [](const Object&) { return true; };
  static constexpr FieldInfo kFriction = kMaterialFields.back();
  std::vector<BodyProperty> all{{kBodyMass.key, &kBodyMass, every, set_mass},
                                {"friction", &kFriction, every, set_friction}};
  // Adds the numbers of a table; `part` is the body's part that it describes.
  const auto add = [&](const char* prefix, const auto& fields, const auto& has, const auto& part) {
    for (const auto& field : fields) {
      if (!field.is_number()) continue;
      all.push_back(
          {std::string(prefix) + field.key, &field, has,
           [&field, part](Object& object, double x) { set_number(field, part(object), x); }});
    }
  };
  const auto joint = [](Object& object) -> BodyJoint& { return *object.body->joint; };
  const auto force = [](Object& object) -> JointForce& { return object.body->joint->force; };
  add("", kMaterialFields, every, [](Object& object) -> Material& { return object.material; });
  add("", kBodyFields, every, [](Object& object) -> Body& { return *object.body; });
  add("joint.", kJointFields, on_joint, joint);
  add("joint.", kStopFields, on_axis, joint);
  add("joint.", kForceFields, on_axis, force);
  add("joint.detent.", kDetentFields, on_axis, force);
  return all;
}

const std::vector<BodyProperty>& properties() {
  static const std::vector<BodyProperty> all = all_properties();
  return all;
}

template <class Which>
std::string names_of(const Which& which) {
  std::vector<std::string> names;
  for (const BodyProperty& each : properties()) {
    if (which(each)) names.push_back(each.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::optional<BodyAxis> body_axis(std::string_view key) {
  if (!key.starts_with(kBodyKey)) return std::nullopt;
  key.remove_prefix(std::string_view(kBodyKey).size());
  BodyAxis axis;
  for (const BodyProperty& each : properties()) {
    const std::string end = "." + each.name;
    if (!key.ends_with(end) || key.size() == end.size()) continue;
    // Prefers joint.friction to friction of a body called "lid.joint".
    if (axis.property != nullptr && axis.property->name.size() > end.size() - 1) {
      continue;
    }
    axis = {std::string(key.substr(0, key.size() - end.size())), &each};
  }
  return axis;
}

std::string body_properties() {
  return fmt::format("{}NAME. and one of {}", kBodyKey,
                     names_of([](const BodyProperty&) { return true; }));
}

std::string why_not(const BodyAxis& axis, const Scene& scene) {
  const std::vector<std::string> names = body_names(scene);
  const auto found = std::ranges::find_if(
      scene.objects, [&](const Object& object) { return object.body && object.name == axis.body; });
  if (found == scene.objects.end()) {
    return fmt::format("no body is called '{}'; allowed: {}", axis.body,
                       names.empty() ? "none, because nothing moves in this scene"
                                     : fmt::format("{}", fmt::join(names, ", ")));
  }
  if (axis.property->has(*found)) return "";
  return fmt::format("'{}' is on {} joint; allowed: {}", axis.body,
                     on_joint(*found) ? "a ball" : "no",
                     names_of([&](const BodyProperty& each) { return each.has(*found); }));
}

void set_of_body(const BodyAxis& axis, double value, SceneDocument& document) {
  for (Object& object : document.scene.objects) {
    if (!object.body || object.name != axis.body) continue;
    axis.property->set(object, value);
    // A mass replaces the density that the scene's file gives.
    if (axis.property->field == &kBodyMass) document.densities.erase(axis.body);
  }
}

}  // namespace limpid
