// Sketch of the check of a device's axes: the arm at rest, and which way the motor pushes its tip.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <optional>

#include "app/device/axis_check_run.h"
#include "core/dynamics/arm_description.h"

namespace limpid {

// View of the sketch: from above x points up and y to the left, from the side x points to the right
// and z up.
enum class PushView : std::uint8_t { above, side };

struct PushArrow {
  PushView view;
  ImVec2 direction;  // unit, in the window: y points down
};
// Returns the motion of the tip at rest for the first push on an axis, in the view that shows it
// best; nothing if the axis does not move the tip. The second push goes the other way.
std::optional<PushArrow> push_arrow(const ArmDescription& arm, int axis);

// Returns the room that the sketch takes.
ImVec2 push_sketch_size();
// Draws the sketch as an item of the open window; nothing if the axis does not move the tip.
// The arrow of the push that `stage` has under way stands out. Returns whether it was drawn.
bool draw_push_sketch(const ArmDescription& arm, int axis, AxisStage stage);

}  // namespace limpid
