// What the colours of the 3D picture stand for.
#pragma once

#include <imgui.h>

namespace limpid {

// Line by line, from the top left corner `at` on.
void draw_picture_legend(ImDrawList& list, ImVec2 at);

}  // namespace limpid
