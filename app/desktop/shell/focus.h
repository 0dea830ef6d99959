// Focus of the keys. A key goes to one owner only: a text field before a question, a question
// before a dialog, a dialog before the recording and the view.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace limpid {

// Returns whether the user types in a text field of ImGui; popup_open(): a menu or a list is open.
bool typing();
bool popup_open();

struct Focus {
  bool text = false;          // a text field is being typed in
  bool popup = false;         // a menu or a list is open
  bool question = false;      // the one about unsaved changes, above any dialog
  std::string_view dialog{};  // the one that is open; empty: none
  std::size_t asked = 0;      // number of a program's question in it
  bool modal = false;         // the dialog asks something: nothing behind it acts
  bool panel = false;         // keys lead through a panel
  bool playback = false;
  bool selection = false;  // an object of the scene is selected
  bool transform = false;  // the selected object follows the mouse

  friend bool operator==(const Focus&, const Focus&) = default;
};

enum class KeyOwner : std::uint8_t {
  view,
  playback,
  selection,
  transform,
  dialog,
  panel,
  popup,
  question,
  text
};
KeyOwner owner_of(const Focus& focus);

// Returns whether the key is Shift, Control, Alt or Super, by GLFW's number.
bool is_modifier(int key);

// Keys that are down. A key that is held while the focus changes is stale until it is let go: its
// repetitions and characters do not reach the new owner. Modifiers are never stale.
class HeldKeys {
 public:
  static constexpr int kKeys = 512;  // more than GLFW has

  // Notes a key by GLFW's number; keys without a number are ignored.
  void press(int key);
  void release(int key);
  void set_focus(const Focus& focus);
  bool stale(int key) const;

 private:
  std::bitset<kKeys> held_, stale_;
  Focus focus_;
};

}  // namespace limpid
