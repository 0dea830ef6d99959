// Whether two states of the view can be told apart in a picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/math/sizes.h"
#include "render/view_state.h"

namespace limpid {

// Nothing is further off than `tolerance` [m], forces as long as their arrows.
bool same_picture(const ViewState& a, const ViewState& b, double tolerance);

// What of a picture has to be drawn anew because it looks different than in the last frame.
using PixelArea = Eigen::AlignedBox2i;  // y up, the upper corner is the first pixel outside

// Things are named in the same order in every frame; one that looks different than its predecessor
// has to be drawn where it is and where that one was.
class Damage {
 public:
  // `to_clip`: the world to clip space; sizes in pixels.
  void begin(const glm::mat4& to_clip, int width, int height);
  // The next thing: all that its look follows from, as bytes, and points of the world whose convex
  // hull holds it, `margin` pixels around that included.
  void add(std::span<const std::byte> look, std::span<const glm::vec3> hull, float margin);
  // Something else has changed: all of it.
  void spoil() { spoilt_ = true; }
  // Where; empty: the picture is the same.
  PixelArea end();
  PixelArea whole() const { return {Eigen::Vector2i::Zero(), size_}; }

 private:
  struct Thing {
    std::uint64_t look;
    PixelArea where;
  };
  PixelArea area_of(std::span<const glm::vec3> hull, float margin) const;

  std::vector<Thing> now_, before_;
  glm::mat4 to_clip_{1.0f};
  Eigen::Vector2i size_ = Eigen::Vector2i::Zero();
  bool spoilt_ = true;
};

// FNV-1a.
std::uint64_t hash_of(std::span<const std::byte> bytes);

// Clip space in which this area alone fills the view: for leaving out what lies beside it.
glm::mat4 cropped(const glm::mat4& to_clip, const PixelArea& area, const PixelArea& whole);

}  // namespace limpid
