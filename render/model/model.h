// A triangle mesh ready to be drawn or touched, and the progress of loading it.
#pragma once

#include <array>
#include <atomic>
#include <compare>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/math/sizes.h"

namespace limpid {

// Progress of a load, and the wish to cancel it; either may be null.
struct LoadProgress {
  std::atomic<double>* part = nullptr;        // 0 to 1
  const std::atomic<bool>* cancel = nullptr;  // asked several times a second
};

struct LoadCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws LoadCancelled if the load is no longer wanted.
inline void check_wanted(const LoadProgress& progress) {
  if (progress.cancel && progress.cancel->load()) throw LoadCancelled("loading was cancelled");
}

struct Vertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;  // unit
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
  Eigen::Vector3f color = Eigen::Vector3f::Constant(0.8f);  // linear, times the texture
  Eigen::Vector2f surface = Eigen::Vector2f(0.0f, 0.5f);    // metallic, roughness
  float opacity = 1;
};

struct Image {
  enum class Wrap : std::uint8_t { repeat, mirror, clamp };
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // top row first
  bool srgb = true;                // colours; numbers otherwise
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

// Look of a part, as far as the vertices do not say. Images are numbers in Model::images, -1 for
// none.
struct Finish {
  enum class Alpha : std::uint8_t { opaque, mask, blend };
  int color = -1;               // times the vertices' colour and opacity
  int surface = -1;             // green: roughness, blue: metallic, times the vertices'
  int normal = -1;              // bumps, in the frame of the texture
  int emission = -1;            // times `glow`
  float bump = 1;               // of the normal texture
  std::array<float, 3> glow{};  // light of its own, linear
  Alpha alpha = Alpha::opaque;
  float cutoff = 0.5f;  // for Alpha::mask: less opaque points are not drawn
  bool two_sided = false;
  bool flat = false;  // each triangle as it lies, not as the vertices' normals say

  auto operator<=>(const Finish&) const = default;  // NOLINT(modernize-use-nullptr)
};

struct Part {
  std::uint32_t first = 0, count = 0;  // indices
  Finish material = {};
};

// A list of vertices and triangles, cut into parts by material.
struct Model {
  enum class Up : std::uint8_t { unsaid, y, z };
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;  // triangles, counter-clockwise from outside
  std::vector<Part> parts;             // one for each material, together all indices in order
  std::vector<Image> images;
  // Coarse version of a large model, with fewer triangles over the same vertices; else empty.
  std::vector<std::uint32_t> coarse;
  std::vector<Part> coarse_parts;
  double unit = 0;                    // of the coordinates, by the file [m]; 0: the file has none
  Up up = Up::unsaid;                 // the axis
  std::vector<std::string> warnings;  // parts of the file left out, a line each

  Eigen::AlignedBox3d bounds() const {
    Eigen::AlignedBox3d box;
    for (const Vertex& v : vertices) box.extend(v.position.cast<double>());
    return box;
  }
};

}  // namespace limpid
