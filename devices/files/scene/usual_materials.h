// Materials that everybody knows, as a hand feels them through a device.
#pragma once

#include <array>

#include "core/touch/material.h"

namespace limpid {

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

// Null for one of the user's own.
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
