// Parts of a picture that must be drawn anew, and whether two states of the view look the same.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/math/sizes.h"
#include "render/view_state.h"

namespace limpid {

// Returns whether nothing is further off than `tolerance` [m]; forces count by the length of their
// arrows.
bool same_picture(const ViewState& a, const ViewState& b, double tolerance);

// Area of a picture in pixels: y up, the upper corner is the first pixel outside.
using PixelArea = Eigen::AlignedBox2i;

// Finds the area of a picture that looks different than in the last frame. Things are named in the
// same order in every frame. One that looks different has to be drawn where it is and where it was.
class Damage {
 public:
  // `to_clip`: the world to clip space; sizes in pixels.
  void begin(const glm::mat4& to_clip, int width, int height);
  // Adds the next thing. `look` has all that its look follows from, as bytes; the convex hull of
  // the points `hull` of the world, and `margin` pixels around, holds it.
  void add(std::span<const std::byte> look, std::span<const glm::vec3> hull, float margin);
  // Marks the whole picture, as something else has changed.
  void spoil() { spoilt_ = true; }
  // Returns the area to be drawn anew; empty: the picture is the same.
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

// Hashes by FNV-1a.
std::uint64_t hash_of(std::span<const std::byte> bytes);

// Returns the clip space in which this area alone fills the view: for leaving out what lies beside
// it.
glm::mat4 cropped(const glm::mat4& to_clip, const PixelArea& area, const PixelArea& whole);

}  // namespace limpid
