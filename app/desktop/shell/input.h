// Input of keys and mouse on its way from the window to the owner of the focus.
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
  bool repeated = false;   // the key is held
  unsigned character = 0;  // character that it wrote, in Unicode; 0: none
};

class KeyInput {
 public:
  // Event of a key or an input method.
  struct Event {
    enum class Kind { press, repeat, release, character } kind;
    int key = 0;
    int modifiers = 0;
    unsigned character = 0;
  };

  // Sets the labels of the keyboard; before the first call they are those of a US one.
  void set_labels(KeyLabels labels) { labels_ = std::move(labels); }
  const KeyLabels& labels() const { return labels_; }
  // Takes GLFW's events in the order in which they happened; `place`: GLFW's name of a key.
  void key(int place, int action, int modifiers);
  void character(unsigned character);

  // Hands keys out before ImGui's frame, and to ImGui its own; to be called once a frame. A frame
  // takes text typed in one go, or one other key, as a key may open something for the next one. It
  // takes all keys up to one that cuts the force.
  void deal(const Focus& focus);
  // Returns whether events are left for the next frame.
  bool waiting() const { return !events_.empty(); }
  // Returns the keys pressed in this frame, without those held since another focus.
  const std::vector<KeyPress>& pressed() const { return pressed_; }
  // Returns the number of presses that frames took so far, without modifiers.
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
  std::array<int, HeldKeys::kKeys> pressed_as_{};  // key that a place was pressed as; 0: none yet
  std::deque<Event> events_;
  HeldKeys held_;
  std::bitset<HeldKeys::kKeys> down_, shown_;  // present keys; as ImGui knows them
  bool in_menu_ = false;                       // or in a panel that keys lead through
  std::vector<KeyPress> pressed_;
  long taken_ = 0;
};

// The mouse on its way from the window to ImGui, which looks once a frame. ImGui would miss clicks
// between two frames, and see others at the wrong place.
class MouseInput {
 public:
  // Notes the time; to be called before GLFW is asked for new events.
  void ask(SteadyClock::time_point now);
  // Takes GLFW's events in the order in which they happened; buttons are ImGui's.
  void move(float x, float y) { at_ = {x, y}; }
  void enter(bool over) { over_ = over; }
  void button(int button, bool down, int modifiers = 0);

  // Gives ImGui one press or release, at its place, a press with its modifiers; else the mouse's
  // place `now`. To be called once a frame, after GLFW's part of ImGui's frame and before ImGui's.
  void deal(const ImVec2& now);
  // Returns whether the mouse is over the window.
  bool over() const { return over_; }
  // Returns the number of presses and releases that frames took so far.
  long taken() const { return taken_; }
  // Returns whether events are left for the next frame.
  bool waiting() const { return !events_.empty(); }

 private:
  struct Event {
    int button;
    int modifiers;     // of GLFW, at the event
    bool down, again;  // again: second press of a double click
    ImVec2 at;
  };

  std::deque<Event> events_;
  std::bitset<ImGuiMouseButton_COUNT> down_;
  ImVec2 at_{0, 0};
  bool over_ = false;
  long taken_ = 0;
  SteadyClock::time_point asked_{}, asked_before_{};
  SteadyClock::time_point pressed_{};  // latest possible time of the left button's last press
};

}  // namespace limpid
