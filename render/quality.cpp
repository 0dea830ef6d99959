#include "render/quality.h"

namespace limpid {

Quality Quality::automatic(std::string_view gl_renderer) {
  for (const char* software : {"llvmpipe", "softpipe", "SWR", "Software Rasterizer"})
    if (gl_renderer.find(software) != std::string_view::npos)
      return {.msaa = 1, .shadow_size = 1024, .soft = false};
  return {};
}

}  // namespace limpid
