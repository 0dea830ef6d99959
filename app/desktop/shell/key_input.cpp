#include "app/desktop/shell/key_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

namespace limpid {

void KeyInput::key(int key, int action, int modifiers) {
  const auto kind = action == GLFW_PRESS    ? Event::Kind::press
                    : action == GLFW_REPEAT ? Event::Kind::repeat
                                            : Event::Kind::release;
  events_.push_back({.kind = kind, .key = key, .modifiers = modifiers});
}

void KeyInput::character(unsigned character) {
  events_.push_back({.kind = Event::Kind::character, .character = character});
}

void KeyInput::deal(const Focus& focus) {
  ImGuiIO& io = ImGui::GetIO();
  for (const int key : std::exchange(tapped_, {})) io.KeysDown[key] = false;
  held_.set_focus(focus);
  const std::vector<KeyPress> down = take_events();
  for (int key = 0; key <= GLFW_KEY_LAST; ++key) {
    if (held_.stale(key)) io.KeysDown[key] = false;
  }
  show_imgui(down);
}

std::vector<KeyPress> KeyInput::take_events() {
  std::vector<KeyPress> down;
  int last = GLFW_KEY_UNKNOWN;  // that a character comes from
  for (const Event& event : std::exchange(events_, {})) {
    if (event.kind != Event::Kind::character) last = event.key;
    switch (event.kind) {
      case Event::Kind::press:
        held_.press(event.key);
        pressed_.push_back({event.key, event.modifiers});
        down.push_back(pressed_.back());
        break;
      case Event::Kind::repeat:
        if (!held_.stale(event.key)) pressed_.push_back({event.key, event.modifiers, true});
        break;
      case Event::Kind::release: held_.release(event.key); break;
      case Event::Kind::character:
        if (!held_.stale(last)) ImGui::GetIO().AddInputCharacter(event.character);
        break;
    }
  }
  return down;
}

// ImGui looks at what is down, and would never see keys let go before it looks.
void KeyInput::show_imgui(const std::vector<KeyPress>& down) {
  ImGuiIO& io = ImGui::GetIO();
  int modifiers = 0;
  for (const KeyPress& press : down) {
    if (press.key < 0 || io.KeysDown[press.key]) continue;
    io.KeysDown[press.key] = true;
    tapped_.push_back(press.key);
    modifiers |= press.modifiers;
  }
  const auto held_down = [&](int modifier, int left, int right) {
    return (modifiers & modifier) != 0 || io.KeysDown[left] || io.KeysDown[right];
  };
  io.KeyCtrl = held_down(GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = held_down(GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  io.KeyAlt = held_down(GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
}

}  // namespace limpid
