#include "app/desktop/shell/input.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/style/imgui_input.h"

#define GLFW_INCLUDE_NONE

namespace limpid {
namespace {

using Kind = KeyInput::Event::Kind;

bool is_control(int key) { return key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL; }

constexpr auto kDoubleClick = std::chrono::milliseconds(300);
// Values of ImGui's time for a second press, as double clicks are found here: all, none, and its
// wait.
constexpr float kAnyTime = 1e9f, kNoTime = 1e-6f, kWaits = 0.35f;  // [s]

}  // namespace

// A key is released as the key it was pressed as, even if the keyboard has changed meanwhile.
void KeyInput::key(int place, int action, int modifiers) {
  int key = labels_.at(place);
  if (place > 0 && place < HeldKeys::kKeys) {
    int& as = pressed_as_[static_cast<std::size_t>(place)];
    if (action == GLFW_PRESS || as == 0) as = key;
    key = as;
  }
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
  in_menu_ = (focus.popup || owner_of(focus) == KeyOwner::panel) && !focus.text;
  lead_menus_by_keys(in_menu_);
  Taken taken = Taken::nothing;
  int last = GLFW_KEY_UNKNOWN;  // key that a character comes from
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

// Returns ImGui's code of a key; 0: none. In a menu ImGui takes an item by the space bar and closes
// it by Esc. Here the space bar cuts the force and Esc is a command, so that Enter takes the item.
// Tab goes to the next item, as it does elsewhere.
int KeyInput::seen_as(int key) const {
  if (!in_menu_) return key;
  if (key == GLFW_KEY_SPACE || key == GLFW_KEY_ESCAPE) return 0;
  if (key == GLFW_KEY_TAB) {
    const bool back = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
    const bool other = down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL);
    return other ? 0 : back ? GLFW_KEY_UP : GLFW_KEY_DOWN;
  }
  return key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER ? GLFW_KEY_SPACE : key;
}

// Shows ImGui the keys that are down, without stale ones.
void KeyInput::show(int modifiers) {
  std::bitset<HeldKeys::kKeys> now;
  for (int key = 0; key <= GLFW_KEY_LAST; ++key) {
    if (held_.stale(key)) set_down(key, false);
    if (down(key) && seen_as(key) != 0) now.set(static_cast<std::size_t>(seen_as(key)));
  }
  for (int key = 1; key <= GLFW_KEY_LAST; ++key) {
    const auto at = static_cast<std::size_t>(key);
    if (now[at] != shown_[at]) show_key(key, now[at]);
  }
  shown_ = now;
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

// Returns whether ImGui has yet to see the key released.
bool KeyInput::just_released(int key) const {
  return key >= 0 && key <= GLFW_KEY_LAST && !down(key) &&
         shown_[static_cast<std::size_t>(seen_as(key))];
}

// Returns whether the next key writes a character, which comes right behind it.
bool KeyInput::types() const {
  return events_.front().kind == Kind::press && events_.size() > 1 &&
         events_[1].kind == Kind::character;
}

// Returns whether the next event has to wait for the next frame.
bool KeyInput::ends_frame(Taken taken) const {
  const Event& next = events_.front();
  if (next.kind == Kind::press && just_released(next.key)) return true;
  if (taken == Taken::nothing || next.kind == Kind::character || next.kind == Kind::repeat)
    return false;
  if (taken == Taken::key) return true;
  return next.kind == Kind::press && (is_modifier(next.key) ? is_control(next.key) : !types());
}

// Returns whether a key that cuts the force is among the events: nothing may delay it.
bool KeyInput::urgent(const Focus& focus) const {
  return std::ranges::any_of(events_, [&](const Event& event) {
    return event.kind == Kind::press &&
           (event.key == GLFW_KEY_ESCAPE || (event.key == GLFW_KEY_SPACE && !focus.text));
  });
}

// Returns the key press of an event that has left the queue. With AltGr only the character counts,
// not the key.
KeyPress KeyInput::press_of(const Event& event) const {
  const bool writes = !events_.empty() && events_.front().kind == Kind::character;
  const bool alt_gr = down(GLFW_KEY_RIGHT_ALT) && (event.modifiers & GLFW_MOD_ALT) == 0;
  return {alt_gr && is_printable(event.key) ? GLFW_KEY_UNKNOWN : event.key, event.modifiers,
          event.kind == Kind::repeat, writes ? events_.front().character : 0};
}

void KeyInput::take(const Event& event, int last) {
  switch (event.kind) {
    case Kind::press:
      held_.press(event.key);
      pressed_.push_back(press_of(event));
      if (!is_modifier(event.key)) ++taken_;
      set_down(event.key, true);
      break;
    case Kind::repeat:
      if (!held_.stale(event.key)) pressed_.push_back(press_of(event));
      break;
    case Kind::release:
      held_.release(event.key);
      set_down(event.key, false);
      break;
    case Kind::character:
      if (!held_.stale(last)) write_character(event.character);
      break;
  }
}

void MouseInput::ask(SteadyClock::time_point now) { asked_before_ = std::exchange(asked_, now); }

void MouseInput::button(int button, bool down, int modifiers) {
  if (button < 0 || button >= ImGuiMouseButton_COUNT) return;
  bool again = false;
  if (down && button == ImGuiMouseButton_Left) {
    // The press came after GLFW was asked before, perhaps right then.
    again = pressed_ != SteadyClock::time_point{} && asked_before_ - pressed_ < kDoubleClick;
    pressed_ = asked_;
  }
  events_.push_back({button, modifiers, down, again, at_});
}

void MouseInput::deal(const ImVec2& now) {
  ImVec2 at = now;
  float second = kWaits;
  if (!events_.empty()) {
    const Event event = events_.front();
    events_.pop_front();
    down_[static_cast<std::size_t>(event.button)] = event.down;
    at = event.at;
    ++taken_;
    if (event.down) {
      // Keys may be ahead of the mouse.
      const auto held = [&](int modifier) { return (event.modifiers & modifier) != 0; };
      show_modifiers(held(GLFW_MOD_CONTROL), held(GLFW_MOD_SHIFT), held(GLFW_MOD_ALT));
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
