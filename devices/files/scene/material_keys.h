// The keys of a material, the same in every table of a scene file that has one, and what they may
// be: for its reader, its writer, and whoever edits it.
#pragma once

#include <array>

#include "core/touch/material.h"
#include "devices/files/scene/scene_limits.h"

namespace limpid {

struct MaterialKey {
  const char* key;
  double Material::*field;
  Range range;
};

inline constexpr std::array kMaterialKeys{
    MaterialKey{"stiffness", &Material::stiffness, scene_limits::kStiffness},
};

// Within what a file may say.
inline void hold(Material& material) {
  for (const MaterialKey& each : kMaterialKeys) {
    double& value = material.*each.field;
    value = each.range.hold(value, Material{}.*each.field);
  }
}

}  // namespace limpid
