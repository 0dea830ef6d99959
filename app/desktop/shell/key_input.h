// Keys on their way from the window to who has the focus.
#pragma once

#include <vector>

#include "app/desktop/shell/focus.h"

namespace limpid {

// A key pressed, with GLFW's names for key and modifiers.
struct KeyPress {
  int key;
  int modifiers;
  bool repeated = false;  // by being held
};

class KeyInput {
 public:
  // What GLFW says, in the order it happened.
  void key(int key, int action, int modifiers);
  void character(unsigned character);

  // Once a frame, before ImGui's: hands the keys out, and to ImGui those that are its own.
  void deal(const Focus& focus);
  // Those pressed in this frame, without those held since somebody else had the focus.
  const std::vector<KeyPress>& pressed() const { return pressed_; }
  void forget_pressed() { pressed_.clear(); }

 private:
  // What a key or an input method did.
  struct Event {
    enum class Kind { press, repeat, release, character } kind;
    int key = 0;
    int modifiers = 0;
    unsigned character = 0;
  };
  // Those that went down since the last frame.
  std::vector<KeyPress> take_events();
  void show_imgui(const std::vector<KeyPress>& down);

  std::vector<Event> events_;
  std::vector<int> tapped_;  // pressed and released within the last frame
  HeldKeys held_;
  std::vector<KeyPress> pressed_;
};

}  // namespace limpid
