// Keys on their way from the window to who has the focus.
#pragma once

#include <imgui.h>

#include <array>
#include <bitset>
#include <deque>
#include <utility>
#include <vector>

#include "app/desktop/shell/focus.h"
#include "app/desktop/shell/key_labels.h"
#include "app/desktop/shell/pacing.h"

namespace limpid {

// A key pressed, with GLFW's names for modifiers and for the key, by its label.
struct KeyPress {
  int key;
  int modifiers;
  bool repeated = false;   // by being held
  unsigned character = 0;  // that it wrote, in Unicode; 0: none
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

  // Labels of the keyboard from now on; before the first call those of a US one.
  void set_labels(KeyLabels labels) { labels_ = std::move(labels); }
  const KeyLabels& labels() const { return labels_; }
  // Events of GLFW in the order in which they happened; `place`: its name of a key.
  void key(int place, int action, int modifiers);
  void character(unsigned character);

  // Once a frame, before ImGui's: hands keys out, and to ImGui those that are its own. A frame
  // takes what was typed in one go, or one other key, as that may have opened something for the
  // next one; all that is before a key that cuts the force.
  void deal(const Focus& focus);
  // Some are left for the next frame.
  bool waiting() const { return !events_.empty(); }
  // Those pressed in this frame, without those held since somebody else had the focus.
  const std::vector<KeyPress>& pressed() const { return pressed_; }
  // Presses that frames took so far, without those of modifiers.
  long taken() const { return taken_; }
  void forget_pressed() { pressed_.clear(); }

 private:
  enum class Taken { nothing, text, key };  // by a frame
  bool types() const;
  int seen_as(int key) const;
  bool just_released(int key) const;
  bool ends_frame(Taken taken) const;
  bool urgent(const Focus& focus) const;
  void take(const Event& event, int last);
  KeyPress press_of(const Event& event) const;
  void set_down(int key, bool down);
  bool down(int key) const { return down_[static_cast<std::size_t>(key)]; }
  void show(int modifiers);

  KeyLabels labels_;
  std::array<int, HeldKeys::kKeys> pressed_as_{};  // the key of a place; 0: none yet
  std::deque<Event> events_;
  HeldKeys held_;
  std::bitset<HeldKeys::kKeys> down_, shown_;  // now; as ImGui was told last
  bool in_menu_ = false;
  std::vector<KeyPress> pressed_;
  long taken_ = 0;
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
  void button(int button, bool down, int modifiers = 0);

  // Once a frame, after GLFW's part of ImGui's frame and before ImGui's: one press or release,
  // where it was, a press with the modifiers that were held then; else where the mouse is `now`.
  void deal(const ImVec2& now);
  // The mouse is over the window.
  bool over() const { return over_; }
  // Presses and releases that frames took so far.
  long taken() const { return taken_; }
  // Some is left for the next frame.
  bool waiting() const { return !events_.empty(); }

 private:
  struct Event {
    int button;
    int modifiers;     // GLFW's, that were held
    bool down, again;  // the second press of a double click
    ImVec2 at;
  };

  std::deque<Event> events_;
  std::bitset<ImGuiMouseButton_COUNT> down_;
  ImVec2 at_{0, 0};
  bool over_ = false;
  long taken_ = 0;
  SteadyClock::time_point asked_{}, asked_before_{};
  SteadyClock::time_point pressed_{};  // at the latest, with the left button
};

}  // namespace limpid
