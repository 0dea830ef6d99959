// Widgets of one field: a slider, a check box or a row of choices.
#pragma once

#include <imgui.h>

#include <limits>

#include "core/tick/parameters.h"

namespace limpid {

// Return the place of a value on the slider of `info`, 0 to 1, and back; beyond the ends it is held
// there. A logarithmic slider whose range begins at zero begins at a millionth of its end.
double slider_place(const FieldInfo& info, double value);
double slider_value(const FieldInfo& info, double place);

// Returns the next value of a grid of steps of about a tenth, of two digits each, with `usual` on
// it; `direction`: 1 up, -1 down. Held within the slider's range, as slider_value() is.
double slider_step(const FieldInfo& info, double value, double usual, int direction);

// Marks on a slider's track, NaN for none: the usual value, and a limit, which is red.
struct SliderMarks {
  double usual = std::numeric_limits<double>::quiet_NaN();
  double limit = std::numeric_limits<double>::quiet_NaN();
};

// Draws a number as a slider at ImGui's cursor over the width left, below an ID of its own; returns
// whether `value` was changed. A right click goes back to the usual value; `broken`: in red.
bool number_slider(const FieldInfo& info, double& value, const SliderMarks& marks, bool broken);

// Draws the frame round a widget whose value breaks a promise.
void draw_broken_frame(ImVec2 from, ImVec2 to);

// Draws the widget for `info` at ImGui's cursor over the width left, and changes `parameters`;
// returns whether it did. `usual` is marked on the slider and a right click goes back to it
// (enumerations by number, bool as 0 or 1, kFromArm for the arm's own). A double click or
// Ctrl+click takes typed numbers. `broken`: the promise that the value breaks, nullptr for none;
// it is shown in red. `limit`: see SliderMarks.
bool parameter_slider(const ParameterInfo& info, Parameters& parameters, double usual,
                      const char* broken = nullptr,
                      double limit = std::numeric_limits<double>::quiet_NaN());

// Draws the same for the number of another field, and its meaning as a tooltip.
bool value_slider(const FieldInfo& info, double& value, double usual);

}  // namespace limpid
