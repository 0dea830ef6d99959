// Keys of a material, the same in every table of a scene file, and their ranges: for reader, writer
// and editor.
#pragma once

#include <array>

#include "core/touch/scene.h"
#include "devices/files/scene/scene_document.h"

namespace limpid {

struct MaterialKey {
  const char* key;
  double Material::*field;
  Range range;
  bool required;      // in files; else the default of Material
  const char* label;  // of its slider
  double slider_minimum, slider_maximum;
  bool logarithmic;
  const char* meaning;  // one or two sentences for people
};

inline constexpr std::array kMaterialKeys{
    MaterialKey{"stiffness", &Material::stiffness, scene_limits::kStiffness, true, "Stiffness", 1,
                1e4, true,
                "How hard it pushes back. Double click to type, right click for the usual value. A "
                "hard surface is felt as hard as the coupling lets through."},
    MaterialKey{"damping", &Material::damping, scene_limits::kDamping, false, "Damping", 0, 20,
                false,
                "What it takes up while it is pressed in or let out; 0 gives all back. Rendered by "
                "the predictive coupling, as far as the tick allows."},
    MaterialKey{"friction_static", &Material::friction_static, scene_limits::kFriction, false,
                "Friction, sticking", 0, 1, false,
                "Up to this part of the pressing force the tip sticks. Rendered by the predictive "
                "coupling."},
    MaterialKey{"friction_kinetic", &Material::friction_kinetic, scene_limits::kFriction, false,
                "Friction, slipping", 0, 1, false,
                "The part of the pressing force that holds the tip back while it slips. Rendered "
                "by the predictive coupling."},
};

// Holds a material within what a file may say.
inline void hold(Material& material) {
  for (const MaterialKey& each : kMaterialKeys) {
    double& value = material.*each.field;
    value = each.range.hold(value, Material{}.*each.field);
  }
}

// A material that everybody knows, as a hand feels it through a device.
struct UsualMaterial {
  const char* name;
  Material material;
};

// Stiffness and damping of a contact with a fingertip or a small tool, not of the bulk; friction
// against skin or plastic, dry.
inline constexpr std::array kUsualMaterials{
    UsualMaterial{"foam", {100, 2, 0.6, 0.5}},        UsualMaterial{"felt", {150, 1, 0.7, 0.6}},
    UsualMaterial{"skin", {300, 3, 0.8, 0.6}},        UsualMaterial{"rubber", {500, 2, 1.0, 0.9}},
    UsualMaterial{"plastic", {1200, 0.5, 0.3, 0.25}}, UsualMaterial{"wood", {1500, 0, 0.4, 0.3}},
    UsualMaterial{"glass", {4000, 0, 0.1, 0.08}},     UsualMaterial{"brass", {5000, 0, 0.25, 0.2}},
    UsualMaterial{"ice", {3000, 0, 0.03, 0.02}}};

// The usual material with these values; null if there is none.
inline const UsualMaterial* usual_material(const Material& material) {
  for (const UsualMaterial& each : kUsualMaterials) {
    const Material& usual = each.material;
    if (usual.stiffness == material.stiffness && usual.damping == material.damping &&
        usual.friction_static == material.friction_static &&
        usual.friction_kinetic == material.friction_kinetic)
      return &each;
  }
  return nullptr;
}

}  // namespace limpid
