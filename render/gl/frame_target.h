// Target of a frame before it comes to the window: with several samples a pixel, or with one and
// edges softened afterwards.
#pragma once

#include <filesystem>
#include <optional>

#include "render/gl/gl_names.h"
#include "render/gl/shader_program.h"

namespace limpid {

class FrameTarget {
 public:
  explicit FrameTarget(const std::filesystem::path& shaders);

  struct Area {
    int x, y, width, height;  // pixels, y up
  };
  // Binds a target of this size, which may differ in every frame. Returns true if it is new and
  // empty, false if it still has the last frame.
  bool begin(int width, int height, int samples);
  // Clears this area; drawing changes it alone from now on.
  void clear(const Area& area);
  // Brings the picture to a rectangle of `framebuffer`, which stays bound; it may be larger. Only
  // `changed` differs from the frame before; an empty area: the same picture again.
  void finish(GLuint framebuffer, const Area& to, const Area& changed);

 private:
  struct Buffers {
    GlFramebuffer drawn, resolved;
    GlRenderbuffer color, depth;
    GlTexture picture;
    // Picture with softened edges, as large as shown; only what changed is softened again.
    GlFramebuffer softened;
    GlTexture soft;
  };
  void allocate();
  void resolve(const Area& changed) const;
  void soften(const Area& to, const Area& changed);
  void show(GLuint picture, const Area& to) const;

  ShaderProgram smooth_, scaled_;
  GlVertexArray no_vertices_;
  std::optional<Buffers> buffers_;
  int width_ = 0, height_ = 0, samples_ = 0;
  int soft_width_ = 0, soft_height_ = 0;  // size of the softened picture
};

}  // namespace limpid
