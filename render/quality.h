// How much work a picture may be.
#pragma once

#include <string_view>

namespace limpid {

struct Quality {
  int msaa = 4;            // samples a pixel; 1: edges are smoothed in the finished picture
  int shadow_size = 2048;  // edge of the shadow map in texels; 0: no shadows
  bool soft = true;        // wide, soft shadow edges

  // What suits the renderer that GL_RENDERER names: a processor drawing in software gets less.
  static Quality automatic(std::string_view gl_renderer);
};

}  // namespace limpid
