// A model in the graphics card's memory.
#pragma once

#include <vector>

#include "render/gl_names.h"
#include "render/model.h"

namespace limpid {

class GpuModel {
 public:
  explicit GpuModel(const Model& model);

  // All triangles at once, textures ignored.
  void draw() const;
  // Part by part with its texture (white where it has none) bound to unit 0.
  void draw_textured(GLuint white) const;

 private:
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
  GLsizei count_;
  std::vector<Part> parts_;
  std::vector<GlTexture> textures_;
};

// A 1 x 1 or larger sRGB texture with mipmaps.
GlTexture upload(const Image& image);

}  // namespace limpid
