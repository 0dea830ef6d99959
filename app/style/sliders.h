// One parameter as a slider, a check box or a row of choices.
#pragma once

#include <imgui.h>

#include "core/tick/parameters.h"

namespace limpid {

// A number as a slider: what value_slider() and parameter_slider() are made of.

bool is_int(const ParameterInfo& info);

// Where a value lies on the slider of `info`, 0 to 1, and back; beyond the ends it is held there.
// A logarithmic slider whose range begins at zero begins at a millionth of its end.
double slider_place(const ParameterInfo& info, double value);
double slider_value(const ParameterInfo& info, double place);

// The next value of a grid of steps of about a tenth, of two digits each, with `usual` on it;
// `direction`: 1 up, -1 down. Held within the slider's range, as slider_value() is.
double slider_step(const ParameterInfo& info, double value, double usual, int direction);

// Draws it at ImGui's cursor over the width left, below an ID of its own; returns whether `value`
// was changed. `usual` is marked and gone back to; `broken`: in red.
bool number_slider(const ParameterInfo& info, double& value, double usual, bool broken);

// The frame round what is broken.
void draw_broken_frame(ImVec2 from, ImVec2 to);

// Draws the widget for `info` at ImGui's cursor over the width left, and changes `parameters`;
// returns whether it did. `usual` is marked on the slider and a right click goes back to it
// (enumerations by number, bool as 0 or 1, kFromArm for the arm's own). A double click or
// Ctrl+click takes typed numbers. `broken`: the promise that the value breaks, nullptr for none;
// it is shown in red.
bool parameter_slider(const ParameterInfo& info, Parameters& parameters, double usual,
                      const char* broken = nullptr);

// The same for a number that is no parameter, described as if it were one of type double; `usual`
// is marked and gone back to. Without a tooltip.
bool value_slider(const ParameterInfo& info, double& value, double usual);

}  // namespace limpid
