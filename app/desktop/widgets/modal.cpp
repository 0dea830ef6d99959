#include "app/desktop/widgets/modal.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <string>
#include <vector>

#include "app/style/imgui_input.h"

namespace limpid {

UiStack::UiStack() : fonts_(ImGui::GetCurrentContext()->FontStack.Size) {}

void UiStack::unwind() const {
  while (ImGui::GetCurrentContext()->FontStack.Size > fonts_) ImGui::PopFont();
  ImGui::ErrorCheckEndFrameRecover(nullptr);
}

namespace {

constexpr const char* kClosing = "the closing button";  // label of the noted closing button

// Returns the key of a note in the storage that ImGui keeps for each window.
ImGuiID key(const char* label) { return ImHashStr((std::string("noted of ") + label).c_str()); }
constexpr const char* kDialog = "is a dialog";

void note_dialog() {
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  window->StateStorage.SetBool(key(kDialog), true);
}

// Notes of one frame.
struct Notes {
  int frame = -1;
  std::vector<NotedPlace> all;
};

Notes& notes() {
  static Notes kept;
  if (const int frame = ImGui::GetFrameCount(); kept.frame != frame) {
    kept.frame = frame;
    kept.all.clear();
  }
  return kept;
}

}  // namespace

bool begin_modal(const char* title, bool& open, const ImVec2& size, bool cross) {
  if (open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetCenter(), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize(size);
  const ImGuiWindowFlags fit = size.y == 0 ? ImGuiWindowFlags_AlwaysAutoResize : 0;
  bool wanted = true;
  const bool drawn =
      ImGui::BeginPopupModal(title, cross ? &wanted : nullptr,
                             ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                 ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | fit);
  if (!wanted) open = false;  // closed by its cross, and ImGui has done so
  if (!drawn) return false;
  if (open) {
    note_dialog();
    return true;
  }
  ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
  return false;
}

bool begin_dialog(const char* title, bool& open, ImGuiWindowFlags flags) {
  const bool drawn = ImGui::Begin(
      title, &open, flags | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  note_dialog();
  return drawn;
}

void close_button(const char* label, bool& open) {
  if (ImGui::Button(label)) open = false;
  note_place(kClosing);
}

bool accepted() {
  // The Enter that opened the dialog does not count.
  if (ImGui::IsWindowAppearing() || ImGui::GetIO().WantTextInput) return false;
  return ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows) &&
         (key_pressed(GLFW_KEY_ENTER, false) || key_pressed(GLFW_KEY_KP_ENTER, false));
}

void note_at(const char* label, ImVec2 place) {
  const ImGuiWindow& window = *ImGui::GetCurrentWindow()->RootWindow;
  notes().all.push_back({window.Name, label, place, window.ID});
}

void note_place(const char* label) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  note_at(label, {0.5f * (from.x + to.x), 0.5f * (from.y + to.y)});
}

bool noted_button(const char* label) {
  const bool pressed = ImGui::Button(label);
  note_place(label);
  return pressed;
}

const std::vector<NotedPlace>& noted_places() { return notes().all; }

std::optional<ImVec2> noted_place(std::string_view window, std::string_view label) {
  const ImGuiID id = ImHashStr(window.data(), window.size());
  for (const NotedPlace& note : notes().all) {
    if (note.id == id && note.label == label) return note.at;
  }
  return std::nullopt;
}

std::optional<DialogPlaces> dialog_places() {
  const ImVector<ImGuiWindow*>& windows = ImGui::GetCurrentContext()->Windows;
  for (int i = windows.Size - 1; i >= 0; --i) {
    const ImGuiWindow& window = *windows[i];
    if (!window.Active || window.Hidden) continue;
    if (!window.StateStorage.GetBool(key(kDialog))) continue;
    const ImRect bar = window.TitleBarRect();
    const ImGuiStyle& style = ImGui::GetStyle();
    const float half = 0.5f * ImGui::GetFontSize();
    return DialogPlaces{
        .cross = {bar.Max.x - style.FramePadding.x - half, bar.Min.y + style.FramePadding.y + half},
        .button = noted_place(window.Name, kClosing)};
  }
  return std::nullopt;
}

}  // namespace limpid
