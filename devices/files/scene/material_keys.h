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
  bool required;      // in files; else it is as a Material has it
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
};

// Within what a file may say.
inline void hold(Material& material) {
  for (const MaterialKey& each : kMaterialKeys) {
    double& value = material.*each.field;
    value = each.range.hold(value, Material{}.*each.field);
  }
}

}  // namespace limpid
