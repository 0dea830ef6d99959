// Tooltips that stand beside what they explain.
#pragma once

#include <imgui.h>

namespace limpid {

// Of the item between two corners [ImGui's coordinates]: beside the panel that it is in, or above
// or below it where that reaches across the window. Pairs with end_tooltip().
void begin_tooltip(ImVec2 from, ImVec2 to);
void end_tooltip();
// Of ImGui's last item, while the mouse is over it.
void tooltip(const char* text);

}  // namespace limpid
