// Where a frame is drawn before it is brought to the window: with several samples a pixel, or
// with one and edges softened afterwards.
#pragma once

#include <filesystem>
#include <optional>

#include "render/gl/gl_names.h"
#include "render/gl/shader_program.h"

namespace limpid {

class FrameTarget {
 public:
  explicit FrameTarget(const std::filesystem::path& shaders);

  // Binds a cleared target of this size; sizes may change every frame.
  void begin(int width, int height, int samples);
  // Brings the picture to a rectangle of `framebuffer`, which stays bound; it may be larger.
  void finish(GLuint framebuffer, int x, int y, int width, int height);

 private:
  struct Buffers {
    GlFramebuffer drawn, resolved;
    GlRenderbuffer color, depth;
    GlTexture picture;
  };
  void allocate();

  ShaderProgram plain_, smooth_;
  GlVertexArray no_vertices_;
  std::optional<Buffers> buffers_;
  int width_ = 0, height_ = 0, samples_ = 0;
};

}  // namespace limpid
