#include "render/gl/gpu_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace limpid {
namespace {

constexpr std::uint32_t kPieceIndices = 3 * 16384;

// A vertex as it travels to the card, a third smaller.
struct PackedVertex {
  std::array<float, 3> position;
  std::array<float, 2> uv;
  std::array<std::int16_t, 4> normal;
  std::array<std::uint8_t, 4> color;    // square roots of linear light, opacity
  std::array<std::uint8_t, 4> surface;  // metallic, roughness, and 255 for flat triangles
};

std::uint8_t byte(float unit) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(unit, 0.0f, 1.0f)));
}

PackedVertex packed(const Vertex& v) {
  PackedVertex out{{v.position.x(), v.position.y(), v.position.z()},
                   {v.uv.x(), v.uv.y()},
                   {},
                   {},
                   {byte(v.surface.x()), byte(v.surface.y()), 0, 0}};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.normal[k] =
        static_cast<std::int16_t>(std::lround(32767.0f * std::clamp(v.normal[i], -1.0f, 1.0f)));
    out.color[k] = byte(std::sqrt(std::max(0.0f, v.color[i])));
  }
  out.color[3] = byte(v.opacity);
  return out;
}

GLint wrap_of(Image::Wrap wrap) {
  return wrap == Image::Wrap::clamp    ? GL_CLAMP_TO_EDGE
         : wrap == Image::Wrap::mirror ? GL_MIRRORED_REPEAT
                                       : GL_REPEAT;
}

std::vector<GpuModel::Piece> cut(const Model& model, const std::vector<std::uint32_t>& indices,
                                 const std::vector<Part>& parts, std::uint32_t base) {
  std::vector<GpuModel::Piece> pieces;
  for (const Part& part : parts)
    for (std::uint32_t from = 0; from < part.count; from += kPieceIndices) {
      GpuModel::Piece piece{
          base + part.first + from, std::min(kPieceIndices, part.count - from), part.material, {}};
      for (std::uint32_t i = 0; i < piece.count; ++i)
        piece.box.extend(model.vertices[indices[part.first + from + i]].position);
      pieces.push_back(piece);
    }
  return pieces;
}

// Makes a field of PackedVertex an input of the shaders.
void attribute(GLuint location, GLint size, GLenum type, GLboolean normalized, std::size_t offset) {
  glVertexAttribPointer(location, size, type, normalized, sizeof(PackedVertex),
                        reinterpret_cast<const void*>(offset));
  glEnableVertexAttribArray(location);
}

}  // namespace

GlTexture upload(const Image& image) {
  GlTexture texture;
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, image.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width, image.height,
               0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(image.wrap_u));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(image.wrap_v));
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

GpuModel::GpuModel(const Model& model)
    : fine_(cut(model, model.indices, model.parts, 0)),
      coarse_(model.coarse.empty() ? fine_
                                   : cut(model, model.coarse, model.coarse_parts,
                                         static_cast<std::uint32_t>(model.indices.size()))) {
  for (const Piece& piece : fine_) box_.extend(piece.box);
  std::vector<PackedVertex> vertices;
  vertices.reserve(model.vertices.size());
  for (const Vertex& v : model.vertices) vertices.push_back(packed(v));
  for (const Part& part : model.parts) {
    if (!part.material.flat) continue;
    for (std::uint32_t i = 0; i < part.count; ++i)
      vertices[model.indices[part.first + i]].surface[2] = 255;
  }
  std::vector<std::uint32_t> indices = model.indices;
  indices.insert(indices.end(), model.coarse.begin(), model.coarse.end());

  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(PackedVertex)),
               vertices.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
               GL_STATIC_DRAW);
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(PackedVertex, position));
  attribute(1, 3, GL_SHORT, GL_TRUE, offsetof(PackedVertex, normal));
  attribute(2, 2, GL_FLOAT, GL_FALSE, offsetof(PackedVertex, uv));
  attribute(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(PackedVertex, color));
  attribute(4, 3, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(PackedVertex, surface));
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  for (const Image& image : model.images) textures_.push_back(upload(image));
}

void GpuModel::draw(const Piece& piece) const {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(piece.count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(piece.first * sizeof(std::uint32_t)));
}

void GpuModel::draw(bool coarse) const {
  const std::vector<Piece>& all = pieces(coarse);
  if (all.empty()) return;
  bind();
  const Piece& last = all.back();  // the pieces follow each other in one list
  draw(Piece{all.front().first, last.first + last.count - all.front().first, {}, {}});
}

}  // namespace limpid
