// A triangle mesh ready to be drawn: one vertex list, cut into parts by texture.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

struct Vertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  // unit
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.8f);  // linear, times the texture
  Eigen::Vector2f surface = Eigen::Vector2f(0.0f, 0.5f);    // metallic, roughness
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // sRGB, top row first
};

struct Part {
  std::uint32_t first = 0, count = 0;  // indices
  int image = -1;                      // -1: no texture
};

struct Model {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
  std::vector<Part> parts;
  std::vector<Image> images;

  Eigen::AlignedBox3d bounds() const {
    Eigen::AlignedBox3d box;
    for (const Vertex& v : vertices) box.extend(v.position.cast<double>());
    return box;
  }
};

}  // namespace limpid
