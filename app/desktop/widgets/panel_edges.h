// What lies at the edges of panels.
#pragma once

#include <imgui.h>

#include "app/plot/plot_frame.h"

namespace limpid {

// A border between panels that can be dragged: changes `size` by the mouse's motion along one axis,
// in `direction`, between `least` and `most` [px at scale 1].
void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most);
// A small tab at the view's edge that folds a panel away, or brings it back.
void fold_tab(const char* name, ScreenRect rect, ImGuiDir arrow, const char* help, bool& wanted);

}  // namespace limpid
