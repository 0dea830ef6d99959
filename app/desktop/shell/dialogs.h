// Dialogs of the window: one table of all, and the texts to read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "app/desktop/base/notices.h"
#include "app/desktop/shell/key_labels.h"
#include "app/desktop/widgets/modal.h"
#include "app/plot/plot_frame.h"

namespace limpid {

// Draws a text to read while `open`; closing it clears `open`.
void draw_help(bool& open, const KeyLabels& labels);
void draw_about(bool& open);
void draw_messages(bool& open, const Notices& notices);

class Desktop;

// Does `work`. An exception becomes a notice, but not the same one in every frame.
template <class Work>
void guard(Notices& notices, Work&& work) {
  guarded([&](const char* what) { notices.say_once(what, true); }, std::forward<Work>(work));
}

// Draws a dialog while `open`, and clears that when it is closed; called in every frame. `view`:
// place of the scene's picture.
using DrawDialog = std::function<void(bool& open, ScreenRect view)>;

// Dialog of the table; one is open at a time.
struct DialogKind {
  enum class Keys : std::uint8_t {
    view,   // go on to the view
    typed,  // go on to the view, but Esc closes it also while the user types in it
    modal   // belong to the dialog: it asks something, and nothing behind it acts
  };

  const char* name;  // in the state of the window, and for commands that open it
  Keys keys;
  DrawDialog (*make)(Desktop&);  // with the dialog's own state; once, after the window is there

  bool modal() const { return keys == Keys::modal; }
};
std::span<const DialogKind> dialog_kinds();
const DialogKind* find_dialog(std::string_view name);  // null: there is none

// Dialog that is open, if any.
class OpenDialog {
 public:
  const DialogKind* kind() const { return kind_; }  // null: none
  std::string_view name() const { return kind_ != nullptr ? kind_->name : std::string_view(); }
  bool modal() const { return kind_ != nullptr && kind_->modal(); }
  void open(std::string_view name);  // one of the table
  void close() { kind_ = nullptr; }

  std::filesystem::path last_folder;  // of the last model, scene or arm; empty: none yet

 private:
  const DialogKind* kind_ = nullptr;
};

class Dialogs {
 public:
  explicit Dialogs(Desktop& desktop);

  // Draws the modal dialogs or the others. The modal ones come last in a frame, with the question
  // about unsaved changes above them.
  void draw(bool modal, ScreenRect view);
  void drop_pictures() { drawn_.clear(); }  // before the OpenGL context goes

 private:
  void draw(const DialogKind& kind, const DrawDialog& draw_it, ScreenRect view);
  void draw_question();

  Desktop& desktop_;
  std::vector<std::pair<const DialogKind*, DrawDialog>> drawn_;
};

}  // namespace limpid
