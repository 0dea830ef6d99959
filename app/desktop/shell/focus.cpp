#include "app/desktop/shell/focus.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

namespace limpid {

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

bool typing() {
  const ImGuiContext& ui = *ImGui::GetCurrentContext();
  const bool wanted =
      ui.WantTextInputNextFrame != -1 ? ui.WantTextInputNextFrame != 0 : ui.IO.WantTextInput;
  return wanted && ui.ActiveId != 0;
}

bool popup_open() {
  const auto& open = ImGui::GetCurrentContext()->OpenPopupStack;
  if (open.empty()) return false;
  const ImGuiWindow* top = open.back().Window;
  return top != nullptr && (top->Flags & ImGuiWindowFlags_Modal) == 0;
}

KeyOwner owner_of(const Focus& focus) {
  if (focus.text) return KeyOwner::text;
  if (focus.popup) return KeyOwner::popup;
  if (focus.question) return KeyOwner::question;
  if (focus.modal) return KeyOwner::dialog;
  if (focus.panel) return KeyOwner::panel;
  if (focus.playback) return KeyOwner::playback;
  if (focus.transform) return KeyOwner::transform;
  return focus.selection ? KeyOwner::selection : KeyOwner::view;
}

void HeldKeys::press(int key) {
  if (key < 0 || key >= kKeys || is_modifier(key)) return;
  held_.set(static_cast<std::size_t>(key));
  stale_.reset(static_cast<std::size_t>(key));
}

void HeldKeys::release(int key) {
  if (key < 0 || key >= kKeys) return;
  held_.reset(static_cast<std::size_t>(key));
  stale_.reset(static_cast<std::size_t>(key));
}

void HeldKeys::set_focus(const Focus& focus) {
  if (focus == focus_) return;
  focus_ = focus;
  stale_ |= held_;
}

bool HeldKeys::stale(int key) const {
  return key >= 0 && key < kKeys && stale_[static_cast<std::size_t>(key)];
}

}  // namespace limpid
