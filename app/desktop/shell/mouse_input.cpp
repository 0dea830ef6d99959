#include "app/desktop/shell/mouse_input.h"

#include <utility>

#include "app/style/imgui_input.h"

namespace limpid {
namespace {

constexpr auto kDoubleClick = std::chrono::milliseconds(300);
// ImGui's time for a second press, which has been found here already: all of it, none, and what is
// waited for it.
constexpr float kAnyTime = 1e9f, kNoTime = 1e-6f, kWaits = 0.35f;  // [s]

}  // namespace

void MouseInput::ask(SteadyClock::time_point now) { asked_before_ = std::exchange(asked_, now); }

void MouseInput::button(int button, bool down) {
  if (button < 0 || button >= ImGuiMouseButton_COUNT) return;
  bool again = false;
  if (down && button == ImGuiMouseButton_Left) {
    // It was at some time since GLFW was asked before, and may have been right then.
    again = pressed_ != SteadyClock::time_point{} && asked_before_ - pressed_ < kDoubleClick;
    pressed_ = asked_;
  }
  events_.push_back({button, down, again, at_});
}

void MouseInput::deal(const ImVec2& now) {
  ImVec2 at = now;
  float second = kWaits;
  if (!events_.empty()) {
    const Event event = events_.front();
    events_.pop_front();
    down_[static_cast<std::size_t>(event.button)] = event.down;
    at = event.at;
    if (event.down) {
      second = event.again ? kAnyTime : kNoTime;
    } else if (waiting()) {
      second = kAnyTime;
    }
  }
  ImGui::GetIO().MouseDoubleClickTime = second;
  show_mouse(at);
  for (std::size_t i = 0; i < down_.size(); ++i) show_mouse_button(static_cast<int>(i), down_[i]);
}

}  // namespace limpid
