// Keys on their way from the window to who has the focus.
#pragma once

#include <imgui.h>

#include <bitset>
#include <deque>
#include <vector>

#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/pacing.h"

namespace limpid {

// A key pressed, with GLFW's names for key and modifiers.
struct KeyPress {
  int key;
  int modifiers;
  bool repeated = false;  // by being held
};

class KeyInput {
 public:
  // What a key or an input method did.
  struct Event {
    enum class Kind { press, repeat, release, character } kind;
    int key = 0;
    int modifiers = 0;
    unsigned character = 0;
  };

  // What GLFW says, in the order it happened.
  void key(int key, int action, int modifiers);
  void character(unsigned character);

  // Once a frame, before ImGui's: hands keys out, and to ImGui those that are its own. A frame
  // takes what was typed in one go, or one other key, as that may have opened something for the
  // next one; all that is before a key that cuts the force.
  void deal(const Focus& focus);
  // Some are left for the next frame.
  bool waiting() const { return !events_.empty(); }
  // Those pressed in this frame, without those held since somebody else had the focus.
  const std::vector<KeyPress>& pressed() const { return pressed_; }
  void forget_pressed() { pressed_.clear(); }

 private:
  enum class Taken { nothing, text, key };  // by a frame
  bool types() const;
  bool just_released(int key) const;
  bool ends_frame(Taken taken) const;
  bool urgent(const Focus& focus) const;
  void take(const Event& event, int last);
  void set_down(int key, bool down);
  bool down(int key) const { return down_[static_cast<std::size_t>(key)]; }
  void show(int modifiers);

  std::deque<Event> events_;
  HeldKeys held_;
  std::bitset<HeldKeys::kKeys> down_, shown_;  // now; as ImGui was told last
  std::vector<KeyPress> pressed_;
};

// The mouse on its way from the window to ImGui, which looks once a frame: what is pressed and let
// go between two frames would be lost, and seen elsewhere than it was.
class MouseInput {
 public:
  // Before GLFW is asked what happened since the last time.
  void ask(SteadyClock::time_point now);
  // What it says then, in the order it happened; buttons are ImGui's.
  void move(float x, float y) { at_ = {x, y}; }
  void enter(bool over) { over_ = over; }
  void button(int button, bool down);

  // Once a frame, after GLFW's part of ImGui's frame and before ImGui's: one press or release,
  // where it was; else where the mouse is `now`.
  void deal(const ImVec2& now);
  // The mouse is over the window.
  bool over() const { return over_; }
  // Some is left for the next frame.
  bool waiting() const { return !events_.empty(); }

 private:
  struct Event {
    int button;
    bool down, again;  // the second press of a double click
    ImVec2 at;
  };

  std::deque<Event> events_;
  std::bitset<ImGuiMouseButton_COUNT> down_;
  ImVec2 at_{0, 0};
  bool over_ = false;
  SteadyClock::time_point asked_{}, asked_before_{};
  SteadyClock::time_point pressed_{};  // at the latest, with the left button
};

}  // namespace limpid
