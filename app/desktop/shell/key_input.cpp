#include "app/desktop/shell/key_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

#include "app/style/imgui_input.h"

namespace limpid {
namespace {

using Kind = KeyInput::Event::Kind;

bool is_control(int key) { return key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL; }

}  // namespace

void KeyInput::key(int key, int action, int modifiers) {
  const auto kind = action == GLFW_PRESS    ? Kind::press
                    : action == GLFW_REPEAT ? Kind::repeat
                                            : Kind::release;
  events_.push_back({.kind = kind, .key = key, .modifiers = modifiers});
}

void KeyInput::character(unsigned character) {
  events_.push_back({.kind = Kind::character, .character = character});
}

void KeyInput::deal(const Focus& focus) {
  held_.set_focus(focus);
  Taken taken = Taken::nothing;
  int last = GLFW_KEY_UNKNOWN;  // that a character comes from
  int modifiers = 0;
  while (!events_.empty() && (urgent(focus) || !ends_frame(taken))) {
    const Event event = events_.front();
    const bool writes = event.kind == Kind::character || (focus.text && types());
    events_.pop_front();
    take(event, last);
    if (event.kind == Kind::press) modifiers |= event.modifiers;
    if (event.kind != Kind::character) last = event.key;
    if (event.kind == Kind::press && !is_modifier(event.key)) {
      taken = writes ? Taken::text : Taken::key;
    } else if (event.kind == Kind::character && taken == Taken::nothing) {
      taken = Taken::text;
    }
  }
  show(modifiers);
}

// To ImGui: what is down, but for what somebody else had the focus for.
void KeyInput::show(int modifiers) {
  for (int key = 0; key <= GLFW_KEY_LAST; ++key) {
    if (held_.stale(key)) set_down(key, false);
    const auto at = static_cast<std::size_t>(key);
    if (down_[at] != shown_[at]) show_key(key, down_[at]);
  }
  shown_ = down_;
  const auto held_down = [&](int modifier, int left, int right) {
    return (modifiers & modifier) != 0 || down(left) || down(right);
  };
  show_modifiers(held_down(GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL),
                 held_down(GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT),
                 held_down(GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT));
}

void KeyInput::set_down(int key, bool down) {
  if (key >= 0 && key <= GLFW_KEY_LAST) down_[static_cast<std::size_t>(key)] = down;
}

// ImGui has yet to see that it was let go.
bool KeyInput::just_released(int key) const {
  return key >= 0 && key <= GLFW_KEY_LAST && !down(key) && shown_[static_cast<std::size_t>(key)];
}

// The next key leaves a character, which comes right behind it.
bool KeyInput::types() const {
  return events_.front().kind == Kind::press && events_.size() > 1 &&
         events_[1].kind == Kind::character;
}

// The next event has to wait for the next frame.
bool KeyInput::ends_frame(Taken taken) const {
  const Event& next = events_.front();
  if (next.kind == Kind::press && just_released(next.key)) return true;
  if (taken == Taken::nothing || next.kind == Kind::character || next.kind == Kind::repeat)
    return false;
  if (taken == Taken::key) return true;
  return next.kind == Kind::press && (is_modifier(next.key) ? is_control(next.key) : !types());
}

// A key that cuts the force waits for nothing.
bool KeyInput::urgent(const Focus& focus) const {
  return std::ranges::any_of(events_, [&](const Event& event) {
    return event.kind == Kind::press &&
           (event.key == GLFW_KEY_ESCAPE || (event.key == GLFW_KEY_SPACE && !focus.text));
  });
}

void KeyInput::take(const Event& event, int last) {
  switch (event.kind) {
    case Kind::press:
      held_.press(event.key);
      pressed_.push_back({event.key, event.modifiers});
      set_down(event.key, true);
      break;
    case Kind::repeat:
      if (!held_.stale(event.key)) pressed_.push_back({event.key, event.modifiers, true});
      break;
    case Kind::release:
      held_.release(event.key);
      set_down(event.key, false);
      break;
    case Kind::character:
      if (!held_.stale(last)) ImGui::GetIO().AddInputCharacter(event.character);
      break;
  }
}

}  // namespace limpid
