#include "app/style/imgui_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui_internal.h>

#include <array>

namespace limpid {
namespace {

#if IMGUI_VERSION_NUM >= 18900
constexpr ImGuiKey kKeypadEnter = ImGuiKey_KeypadEnter;
#else
constexpr ImGuiKey_ kKeypadEnter = ImGuiKey_KeyPadEnter;
#endif

struct Key {
  int glfw;
  decltype(kKeypadEnter) imgui;
};

// Keys that ImGui does something for.
constexpr std::array kKeys{
    Key{GLFW_KEY_TAB, ImGuiKey_Tab},
    Key{GLFW_KEY_LEFT, ImGuiKey_LeftArrow},
    Key{GLFW_KEY_RIGHT, ImGuiKey_RightArrow},
    Key{GLFW_KEY_UP, ImGuiKey_UpArrow},
    Key{GLFW_KEY_DOWN, ImGuiKey_DownArrow},
    Key{GLFW_KEY_PAGE_UP, ImGuiKey_PageUp},
    Key{GLFW_KEY_PAGE_DOWN, ImGuiKey_PageDown},
    Key{GLFW_KEY_HOME, ImGuiKey_Home},
    Key{GLFW_KEY_END, ImGuiKey_End},
    Key{GLFW_KEY_INSERT, ImGuiKey_Insert},
    Key{GLFW_KEY_DELETE, ImGuiKey_Delete},
    Key{GLFW_KEY_BACKSPACE, ImGuiKey_Backspace},
    Key{GLFW_KEY_SPACE, ImGuiKey_Space},
    Key{GLFW_KEY_ENTER, ImGuiKey_Enter},
    Key{GLFW_KEY_ESCAPE, ImGuiKey_Escape},
    Key{GLFW_KEY_KP_ENTER, kKeypadEnter},
    Key{GLFW_KEY_A, ImGuiKey_A},
    Key{GLFW_KEY_C, ImGuiKey_C},
    Key{GLFW_KEY_V, ImGuiKey_V},
    Key{GLFW_KEY_X, ImGuiKey_X},
    Key{GLFW_KEY_Y, ImGuiKey_Y},
    Key{GLFW_KEY_Z, ImGuiKey_Z},
};

ImGuiID number_item = 0;  // that had the keys last

#if IMGUI_VERSION_NUM >= 18900
// Returns ImGui's key, also for the digits that Limpid asks for.
ImGuiKey imgui_key(int key) {
  if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) {
    return static_cast<ImGuiKey>(ImGuiKey_0 + key - GLFW_KEY_0);
  }
  if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) {
    return static_cast<ImGuiKey>(ImGuiKey_Keypad0 + key - GLFW_KEY_KP_0);
  }
  for (const Key& each : kKeys) {
    if (each.glfw == key) return each.imgui;
  }
  return ImGuiKey_None;
}
#endif

}  // namespace

void write_character(unsigned character) {
  const bool number = ImGui::GetActiveID() != 0 && ImGui::GetActiveID() == number_item;
  ImGui::GetIO().AddInputCharacter(number && character == ',' ? '.' : character);
}

void note_number_item() {
  if (ImGui::IsItemActive()) number_item = ImGui::GetActiveID();
}

void lead_menus_by_keys(bool lead) {
  constexpr int kKeyboard = ImGuiConfigFlags_NavEnableKeyboard;
  int& flags = ImGui::GetIO().ConfigFlags;
  if (((flags & kKeyboard) != 0) == lead) return;
  flags = lead ? flags | kKeyboard : flags & ~kKeyboard;
  ImGuiContext& ui = *ImGui::GetCurrentContext();
  if (!lead) ui.NavDisableHighlight = true;
  ui.NavDisableMouseHover = false;
}

void lead_window_by_keys() {
  ImGuiContext& ui = *ImGui::GetCurrentContext();
  if (!ui.OpenPopupStack.empty()) return;
  ImGuiWindow* window = ImGui::GetCurrentWindow();
  if (ui.NavWindow == nullptr || ui.NavWindow->RootWindow != window->RootWindow || ui.NavId == 0) {
    ImGui::FocusWindow(window);
    ImGui::NavInitWindow(window, true);
  }
  show_chosen_item();
}

void show_chosen_item() { ImGui::GetCurrentContext()->NavDisableHighlight = false; }

int menus_open() { return ImGui::GetCurrentContext()->OpenPopupStack.Size; }

int step_to_menu_beside(int before) {
  if (before != 1 || menus_open() != 1) return 0;
  const int step = static_cast<int>(key_pressed(GLFW_KEY_RIGHT)) - key_pressed(GLFW_KEY_LEFT);
  if (step != 0) ImGui::NavMoveRequestCancel();
  return step;
}

#if IMGUI_VERSION_NUM >= 18900

void begin_imgui_input() {
  // ImGui would spread events over several frames, which Limpid has done already.
  ImGui::GetIO().ConfigInputTrickleEventQueue = false;
  // Ctrl+Tab does not go through ImGui's windows.
  ImGuiContext& ui = *ImGui::GetCurrentContext();
  ui.ConfigNavWindowingKeyNext = ui.ConfigNavWindowingKeyPrev = ImGuiKey_None;
}

void show_key(int key, bool down) {
  if (const ImGuiKey known = imgui_key(key); known != ImGuiKey_None) {
    ImGui::GetIO().AddKeyEvent(known, down);
  }
}

void show_modifiers(bool control, bool shift, bool alt) {
  ImGuiIO& io = ImGui::GetIO();
  io.AddKeyEvent(ImGuiMod_Ctrl, control);
  io.AddKeyEvent(ImGuiMod_Shift, shift);
  io.AddKeyEvent(ImGuiMod_Alt, alt);
}

void show_mouse(const ImVec2& at) { ImGui::GetIO().AddMousePosEvent(at.x, at.y); }

void show_mouse_button(int button, bool down) { ImGui::GetIO().AddMouseButtonEvent(button, down); }

bool key_pressed(int key, bool repeat) {
  const ImGuiKey known = imgui_key(key);
  return known != ImGuiKey_None && ImGui::IsKeyPressed(known, repeat);
}

#else

void begin_imgui_input() {
  for (const Key& key : kKeys) ImGui::GetIO().KeyMap[key.imgui] = key.glfw;
}

void show_key(int key, bool down) {
  if (key >= 0 && key <= GLFW_KEY_LAST) ImGui::GetIO().KeysDown[key] = down;
}

void show_modifiers(bool control, bool shift, bool alt) {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyCtrl = control;
  io.KeyShift = shift;
  io.KeyAlt = alt;
}

void show_mouse(const ImVec2& at) { ImGui::GetIO().MousePos = at; }

void show_mouse_button(int button, bool down) { ImGui::GetIO().MouseDown[button] = down; }

bool key_pressed(int key, bool repeat) { return ImGui::IsKeyPressed(key, repeat); }

#endif

}  // namespace limpid
