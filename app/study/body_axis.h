// Axes of sweeps that are properties of bodies: scene.body.NAME.mass and the like.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "devices/files/scene/scene_document.h"

namespace limpid {

// Of the keys of an axis the part before a body's name.
inline constexpr const char* kBodyKey = "scene.body.";

struct BodyProperty {
  // What a body must be on to have it.
  enum class Of : std::uint8_t { any_body, any_joint, slider_or_hinge };

  const char* name;  // what a key ends with
  Range range;
  Of of;
  void (*set)(Object&, double);
};

// What a key names: scene.body.NAME.PROPERTY; nothing where it is no such key. The name may have
// dots.
struct BodyAxis {
  std::string body;
  const BodyProperty* property = nullptr;  // none: there is no such property
};
std::optional<BodyAxis> body_axis(std::string_view key);
// All properties, for messages: "scene.body.NAME. and mass, stiffness, ...".
std::string body_properties();

// Whether the scene has such a body with such a property; else what is wrong, with what is allowed.
std::string why_not(const BodyAxis& axis, const Scene& scene);
// Precondition: it has.
void set_of_body(const BodyAxis& axis, double value, SceneDocument& document);

}  // namespace limpid
