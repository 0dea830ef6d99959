// Who the keys belong to. A key goes to one owner only: a text field before a question, a question
// before a dialog, a dialog before the recording and the view.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limpid {

// Of ImGui: a text field is being typed in; a menu or a list is open.
bool typing();
bool popup_open();

struct Focus {
  bool text = false;          // a text field is being typed in
  bool popup = false;         // a menu or a list is open
  bool question = false;      // about unsaved changes, above any dialog
  std::string_view dialog{};  // that is open; empty: none
  std::size_t asked = 0;      // the number of the question in it that a program asks
  bool modal = false;         // it asks something: nothing behind it acts meanwhile
  bool playback = false;
  bool selection = false;  // an object of the scene is selected
  bool transform = false;  // and follows the mouse

  friend bool operator==(const Focus&, const Focus&) = default;
};

enum class KeyOwner : std::uint8_t {
  view,
  playback,
  selection,
  transform,
  dialog,
  popup,
  question,
  text
};
KeyOwner owner_of(const Focus& focus);

// Shift, Control, Alt or Super, by GLFW's number.
bool is_modifier(int key);

// Keys that are down. One that is held while the focus goes elsewhere is stale until it is let go:
// neither its repetitions nor its characters reach the new owner. Modifiers never are.
class HeldKeys {
 public:
  static constexpr int kKeys = 512;  // more than GLFW has

  // By GLFW's numbers; what has none is not followed.
  void press(int key);
  void release(int key);
  void set_focus(const Focus& focus);
  bool stale(int key) const;

 private:
  std::bitset<kKeys> held_, stale_;
  Focus focus_;
};

}  // namespace limpid
