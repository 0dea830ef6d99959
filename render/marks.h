// Signs that explain the picture: arrows for forces, the hand, contacts, trails, the grid.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "core/dynamics/arm_description.h"
#include "render/camera.h"
#include "render/gl/line_batch.h"
#include "render/palette.h"
#include "render/view_state.h"

namespace limpid {

inline constexpr double kMetersPerNewton = 0.02;  // of an arrow
inline constexpr double kPenLength = 0.12;        // of a tool in the hand [m]

struct SolidMark {
  enum class Shape { tube, cone, ball };
  Shape shape;
  glm::mat4 place;
  palette::Rgb color;
};

struct FlashMark {
  glm::mat4 place;
  glm::vec2 pulse;  // strength and radius of the ring, 0 to 1
};

struct Marks {
  std::vector<SolidMark> solids;
  std::vector<SolidMark> glass;  // translucent
  std::vector<glm::mat4> shades;
  std::vector<FlashMark> flashes;
};

// Collects the marks of a state. Their sizes are in pixels, so that they stay readable; only arrows
// and pens have lengths in metres (kMetersPerNewton, kPenLength).
Marks collect_marks(const ViewState& state, const Camera& camera, double pixel_scale);

// Adds lines that others can hide, and lines on top of everything.
void add_trails(const ViewState& state, LineBatch& lines);
void add_lines_on_top(const ViewState& state, LineBatch& lines);
// Adds the axis of each joint, in its colour.
void add_joints(const ArmDescription& arm, const ArmPose& pose, Theme theme, LineBatch& lines);
// Adds lines at multiples of 5 cm in a flat box, fading towards its edges.
void add_grid(const Bounds& area, Theme theme, LineBatch& lines);

}  // namespace limpid
