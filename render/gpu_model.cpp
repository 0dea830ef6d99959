#include "render/gpu_model.h"

#include <cstddef>

namespace limpid {

GlTexture upload(const Image& image) {
  GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, image.width, image.height, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

GpuModel::GpuModel(const Model& model)
    : count_(static_cast<GLsizei>(model.indices.size())), parts_(model.parts) {
  static_assert(sizeof(Vertex) == 13 * sizeof(float));
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(model.vertices.size() * sizeof(Vertex)),
               model.vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(model.indices.size() * sizeof(std::uint32_t)),
               model.indices.data(), GL_STATIC_DRAW);
  std::size_t offset = 0;
  GLuint location = 0;
  for (const int size : {3, 3, 2, 3, 2}) {  // the fields of Vertex, in order
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(location++);
    offset += static_cast<std::size_t>(size) * sizeof(float);
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  for (const Image& image : model.images) textures_.push_back(upload(image));
}

void GpuModel::draw() const {
  glBindVertexArray(array_);
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

void GpuModel::draw_textured(GLuint white) const {
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(array_);
  if (textures_.empty()) {  // the usual case: one call for everything
    glBindTexture(GL_TEXTURE_2D, white);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    return;
  }
  for (const Part& part : parts_) {
    glBindTexture(GL_TEXTURE_2D,
                  part.image < 0 ? white : textures_[static_cast<std::size_t>(part.image)]);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(part.first * sizeof(std::uint32_t)));
  }
}

}  // namespace limpid
