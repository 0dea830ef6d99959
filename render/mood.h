// Light and background of the two themes.
#pragma once

#include <glm/glm.hpp>

#include "render/view_state.h"

namespace limpid {

// Linear light; the backdrop's two colours are sRGB.
struct Mood {
  glm::vec4 key, sky, earth, ground, top, bottom;
  glm::vec4 outline;      // of what is highlighted, sRGB
  glm::vec4 object_tint;  // of what can be touched, linear; w: how much
};

Mood mood_of(Theme theme);

}  // namespace limpid
