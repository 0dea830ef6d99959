// A model in the graphics card's memory.
#pragma once

#include <vector>

#include "render/gl/gl_names.h"
#include "render/model/model.h"

namespace limpid {

class GpuModel {
 public:
  // A piece of a part that is drawn in one call, small enough to be worth leaving out.
  struct Piece {
    std::uint32_t first, count;  // indices
    Finish material;
    Eigen::AlignedBox3f box;
  };

  explicit GpuModel(const Model& model);

  // The coarse pieces are the fine ones where the model has none.
  const std::vector<Piece>& pieces(bool coarse) const { return coarse ? coarse_ : fine_; }
  const Eigen::AlignedBox3f& box() const { return box_; }
  GLuint texture(int image) const { return textures_[static_cast<std::size_t>(image)]; }

  void bind() const { glBindVertexArray(array_); }
  void draw(const Piece& piece) const;   // after bind()
  void draw(bool coarse = false) const;  // all of it, binds

 private:
  GlVertexArray array_;
  GlBuffer vertices_, indices_;
  std::vector<Piece> fine_, coarse_;
  Eigen::AlignedBox3f box_;
  std::vector<GlTexture> textures_;
};

// Makes a texture with mipmaps, at least 1 x 1 pixels.
GlTexture upload(const Image& image);

}  // namespace limpid
