// Axes of sweeps that are properties of bodies: scene.body.NAME.mass and the like.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "devices/files/scene/scene_document.h"

namespace limpid {

// Prefix of a body's keys; the body's name follows.
inline constexpr const char* kBodyKey = "scene.body.";

// A number among the fields of a scene's file (devices/files/scene/scene_fields.h).
struct BodyProperty {
  std::string name;  // end of the key: "joint.damping"
  const FieldInfo* field;
  std::function<bool(const Object&)> has;  // whether this body has it
  std::function<void(Object&, double)> set;
};

// An axis' key taken apart: scene.body.NAME.PROPERTY, where NAME may have dots.
struct BodyAxis {
  std::string body;
  const BodyProperty* property = nullptr;  // null: no such property
};
// Nothing if `key` does not begin with kBodyKey or ends with no property.
std::optional<BodyAxis> body_axis(std::string_view key);
// All properties, for messages: "scene.body.NAME. and mass, stiffness, ...".
std::string body_properties();

// Why the scene has no such body or property, with what is allowed; empty if it has them.
std::string why_not(const BodyAxis& axis, const Scene& scene);
// Precondition: why_not() is empty.
void set_of_body(const BodyAxis& axis, double value, SceneDocument& document);

}  // namespace limpid
