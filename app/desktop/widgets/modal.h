// Dialogs: how they open and close, and where that is clicked.
#pragma once

#include <imgui.h>

#include <exception>
#include <optional>
#include <utility>

namespace limpid {

// What throws in a frame becomes a notice, and the next frame comes.

// Closes whatever ImGui windows, groups and styles an exception left open.
class UiStack {
 public:
  UiStack();
  void unwind() const;

 private:
  int fonts_;
};

// Does `work`; `complain(what)` hears of an exception. Drawing may be left in the middle, if it
// began outside of other ImGui windows.
template <class Work, class Complain>
void guarded(Complain&& complain, Work&& work) {
  const UiStack before;
  try {
    std::forward<Work>(work)();
  } catch (const std::exception& e) {
    before.unwind();
    complain(e.what());
  }
}

// One that asks something: what is behind it is dimmed and waits. To be called in every frame,
// outside of other windows. True while the dialog is to be drawn; it pairs with ImGui::EndPopup()
// then. Its cross clears `open`. `size` [px]; 0: as the content needs.
bool begin_modal(const char* title, bool& open, const ImVec2& size);

// A window beside the others; pairs with ImGui::End() whatever it returns. Its cross clears `open`.
bool begin_dialog(const char* title, bool& open, ImGuiWindowFlags flags);

// The button that closes the dialog being drawn, as its cross and Esc do.
void close_button(const char* label, bool& open);

// Enter was pressed in the dialog being drawn, and not in a text field, which takes it itself.
bool accepted();

// Says where the item just drawn is to who drives the window from outside.
void note_place(const char* label);
void note_at(const char* label, ImVec2 place);  // the same of what is no item
bool noted_button(const char* label);           // a button that does so
// The middle of one that was drawn in the last frame, in a window [px]; nothing: it was not.
std::optional<ImVec2> noted_place(const char* window, const char* label);

// Where the topmost dialog is closed [px].
struct DialogPlaces {
  ImVec2 cross;
  std::optional<ImVec2> button;
};
std::optional<DialogPlaces> dialog_places();

}  // namespace limpid
