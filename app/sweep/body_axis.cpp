#include "app/sweep/body_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace limpid {

namespace {

using namespace scene_limits;
using Of = BodyProperty::Of;

// Sets the mass by the density: moments, if given, scale with it.
void set_mass(Object& object, double mass) {
  Body& body = *object.body;
  if (body.inertia) *body.inertia *= mass / body.mass;
  body.mass = mass;
}

JointForce& force_of(Object& object) { return object.body->joint->force; }

constexpr BodyProperty kProperties[] = {
    {"mass", kMass, Of::any_body, set_mass},
    {"stiffness", kStiffness, Of::any_body,
     [](Object& object, double x) { object.material.stiffness = x; }},
    {"friction", kFriction, Of::any_body,
     [](Object& object, double x) {
       object.material.friction_static = object.material.friction_kinetic = x;
     }},
    {"friction_static", kFriction, Of::any_body,
     [](Object& object, double x) { object.material.friction_static = x; }},
    {"friction_kinetic", kFriction, Of::any_body,
     [](Object& object, double x) { object.material.friction_kinetic = x; }},
    {"contact_stiffness", kStiffness, Of::any_body,
     [](Object& object, double x) { object.body->contact_stiffness = x; }},
    {"restitution", kFriction, Of::any_body,
     [](Object& object, double x) { object.body->restitution = x; }},
    {"joint.damping", kDamping, Of::any_joint,
     [](Object& object, double x) { object.body->joint->damping = x; }},
    {"joint.friction", kJointForce, Of::any_joint,
     [](Object& object, double x) { object.body->joint->friction = x; }},
    {"joint.spring", kJointSpring, Of::slider_or_hinge,
     [](Object& object, double x) { force_of(object).spring = x; }},
    {"joint.detent.force", kJointForce, Of::slider_or_hinge,
     [](Object& object, double x) { force_of(object).detent_force = x; }},
    {"joint.detent.period", kPeriod, Of::slider_or_hinge,
     [](Object& object, double x) { force_of(object).detent_period = x; }},
};

}  // namespace

std::optional<BodyAxis> body_axis(std::string_view key) {
  if (!key.starts_with(kBodyKey)) return std::nullopt;
  key.remove_prefix(std::string_view(kBodyKey).size());
  BodyAxis axis;
  for (const BodyProperty& each : kProperties) {
    const std::string end = std::string(".") + each.name;
    if (!key.ends_with(end) || key.size() == end.size()) continue;
    // Prefers joint.friction to friction of a body called "lid.joint".
    if (axis.property != nullptr && std::string_view(axis.property->name).size() > end.size() - 1) {
      continue;
    }
    axis = {std::string(key.substr(0, key.size() - end.size())), &each};
  }
  return axis;
}

std::string body_properties() {
  std::vector<std::string> names;
  for (const BodyProperty& each : kProperties) names.emplace_back(each.name);
  return fmt::format("{}NAME. and one of {}", kBodyKey, fmt::join(names, ", "));
}

std::string why_not(const BodyAxis& axis, const Scene& scene) {
  const std::vector<std::string> names = body_names(scene);
  const auto found = std::ranges::find_if(
      scene.objects, [&](const Object& object) { return object.body && object.name == axis.body; });
  if (found == scene.objects.end()) {
    return fmt::format("no body is called '{}'; allowed: {}", axis.body,
                       names.empty() ? "none, nothing moves in this scene"
                                     : fmt::format("{}", fmt::join(names, ", ")));
  }
  const auto& joint = found->body->joint;
  if (axis.property->of != Of::any_body && !joint) {
    return fmt::format("'{}' is on no joint; allowed: what does not begin with joint.", axis.body);
  }
  if (axis.property->of == Of::slider_or_hinge && joint->kind == BodyJoint::Kind::ball) {
    return fmt::format(
        "'{}' is on a ball joint; allowed: joint.damping, joint.friction, and what does not begin "
        "with joint.",
        axis.body);
  }
  return "";
}

void set_of_body(const BodyAxis& axis, double value, SceneDocument& document) {
  for (Object& object : document.scene.objects) {
    if (!object.body || object.name != axis.body) continue;
    axis.property->set(object, value);
    // A mass replaces the density that the scene's file gives.
    if (std::string_view(axis.property->name) == "mass") document.densities.erase(axis.body);
  }
}

}  // namespace limpid
