#include "app/desktop/widgets/modal.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace limpid {

bool begin_modal(const char* title, bool& open, const ImVec2& size) {
  if (open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize(size);
  const ImGuiWindowFlags fit = size.y == 0 ? ImGuiWindowFlags_AlwaysAutoResize : 0;
  bool wanted = true;
  if (!ImGui::BeginPopupModal(title, &wanted,
                              ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                  ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | fit)) {
    return false;
  }
  if (open && wanted) return true;
  open = false;
  ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return false;
}

bool accepted() {
  // The Enter that opened the dialog is not its own.
  if (ImGui::IsWindowAppearing() || ImGui::GetIO().WantTextInput) return false;
  return ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
         (ImGui::IsKeyPressed(GLFW_KEY_ENTER, false) ||
          ImGui::IsKeyPressed(GLFW_KEY_KP_ENTER, false));
}

}  // namespace limpid
