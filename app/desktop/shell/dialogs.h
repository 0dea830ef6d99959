// The dialogs of the window: one table, and those that there are to read.
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

// While `open`; closing it clears that.
void draw_help(bool& open, const KeyLabels& labels);
void draw_about(bool& open);

// What opens over the window: one table of dialogs.
class Desktop;

// What throws becomes a notice, but not the same one in every frame.
template <class Work>
void guard(Notices& notices, Work&& work) {
  guarded([&](const char* what) { notices.say_once(what, true); }, std::forward<Work>(work));
}

// Draws a dialog while `open`, and clears that where it was closed; called in every frame. `view`:
// where the picture of the scene is.
using DrawDialog = std::function<void(bool& open, ScreenRect view)>;

// One is open at a time.
struct DialogKind {
  enum class Keys : std::uint8_t {
    view,   // go on to what is behind it
    typed,  // the same, but Esc closes it also while somebody types in it
    modal   // are its own: it asks something, and nothing behind it acts meanwhile
  };

  const char* name;  // in the state of the window; commands open it by that
  Keys keys;
  DrawDialog (*make)(Desktop&);  // with what it remembers; once, after the window is there

  bool modal() const { return keys == Keys::modal; }
};
std::span<const DialogKind> dialog_kinds();
const DialogKind* find_dialog(std::string_view name);  // null: there is none

// Which one is open.
class OpenDialog {
 public:
  const DialogKind* kind() const { return kind_; }  // null: none
  std::string_view name() const { return kind_ != nullptr ? kind_->name : std::string_view(); }
  bool modal() const { return kind_ != nullptr && kind_->modal(); }
  void open(std::string_view name);  // of the table
  void close() { kind_ = nullptr; }

  std::filesystem::path last_folder;  // that a model or an arm came from; empty: none yet

 private:
  const DialogKind* kind_ = nullptr;
};

class Dialogs {
 public:
  explicit Dialogs(Desktop& desktop);

  // Those that are modal, or the others. The modal ones, with the question about unsaved changes
  // above them, come last in a frame.
  void draw(bool modal, ScreenRect view);
  void drop_pictures() { drawn_.clear(); }  // before the OpenGL context goes

 private:
  void draw(const DialogKind& kind, const DrawDialog& draw_it, ScreenRect view);
  void draw_question();

  Desktop& desktop_;
  std::vector<std::pair<const DialogKind*, DrawDialog>> drawn_;
};

}  // namespace limpid
