// Straight lines with a thickness in pixels and soft edges: each is a quad turned to the viewer.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/gl/gl_names.h"

namespace limpid {

class LineBatch {
 public:
  enum class Ends { round, flat };
  LineBatch();

  void clear() { lines_.clear(); }
  // Adds a line. Colours are sRGB with alpha; width in pixels.
  void add(const glm::vec3& from, const glm::vec3& to, float width, const glm::vec4& color_from,
           const glm::vec4& color_to, Ends ends = Ends::round);
  // Needs the "line" program in use.
  void draw();

  struct Line {
    glm::vec3 from;
    float width;
    glm::vec3 to;
    float round_ends;
    glm::vec4 color_from, color_to;
  };
  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
  GlVertexArray array_;
  GlBuffer buffer_;
};

}  // namespace limpid
