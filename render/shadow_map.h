// What the key light sees: a depth picture of the scene from its side.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "render/camera.h"
#include "render/damage.h"
#include "render/gl/gl_names.h"

namespace limpid {

class ShadowMap {
 public:
  explicit ShadowMap(int size);  // edge in texels, 0: none

  // Aims the light, given as the unit vector towards it, at a box of the world.
  void aim(const Bounds& box, const glm::vec3& to_light);
  // Casters are drawn with clip() * model: first, seldom, those that stay where they are, then in
  // an area the others on a copy of that.
  void begin_still() const;
  void begin_moving(const PixelArea& area) const;
  void bind(GLuint unit) const;

  int size() const { return size_; }
  const glm::mat4& clip() const { return clip_; }  // world to the map's clip space
  glm::mat4 lookup() const;                        // world to 0..1 in the map
  float texel() const { return texel_; }           // edge of one texel in the world [m]

 private:
  int size_;
  struct Layer {
    GlTexture depth;
    GlFramebuffer framebuffer;
  };
  void allocate(const Layer& layer) const;

  Layer still_, all_;
  glm::mat4 clip_{1.0f};
  float texel_ = 0;
};

}  // namespace limpid
