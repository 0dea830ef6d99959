// The mouse on its way from the window to ImGui, which looks once a frame: what is pressed and let
// go between two frames would be lost, and seen elsewhere than it was.
#pragma once

#include <imgui.h>

#include <bitset>
#include <deque>

#include "app/desktop/shell/pacing.h"

namespace limpid {

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
