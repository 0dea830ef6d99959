// Dialogs that ask something: what is behind them is dimmed and waits.
#pragma once

#include <imgui.h>

namespace limpid {

// To be called in every frame, outside of other windows. True while the dialog is to be drawn; it
// pairs with ImGui::EndPopup() then. Its cross clears `open`. `size` [px]; 0: as the content needs.
bool begin_modal(const char* title, bool& open, const ImVec2& size);

// Enter was pressed in the dialog being drawn, and not in a text field, which takes it itself.
bool accepted();

}  // namespace limpid
