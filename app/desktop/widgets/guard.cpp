#include "app/desktop/widgets/guard.h"

#include <imgui.h>
#include <imgui_internal.h>

namespace limpid {

UiStack::UiStack() : fonts_(ImGui::GetCurrentContext()->FontStack.Size) {}

void UiStack::unwind() const {
  while (ImGui::GetCurrentContext()->FontStack.Size > fonts_) ImGui::PopFont();
  ImGui::ErrorCheckEndFrameRecover(nullptr);
}

}  // namespace limpid
