// One parameter as a slider, a check box or a row of choices.
#pragma once

#include "app/style/number_slider.h"
#include "core/tick/parameters.h"

namespace limpid {

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
