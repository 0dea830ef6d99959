// Dialogs: how they open and close, and the places where programs may click them.
#pragma once

#include <imgui.h>

#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limpid {

// Closes whatever ImGui windows, groups and styles an exception left open.
class UiStack {
 public:
  UiStack();
  void unwind() const;

 private:
  int fonts_;
};

// Does `work`, and calls `complain(message)` on an exception, so that the next frame comes. Ends
// unfinished drawing, if that began outside of other ImGui windows.
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

// Begins a modal dialog: all behind it is dimmed and waits. To be called in every frame, outside of
// other windows. Returns true while the dialog is to be drawn; then pairs with ImGui::EndPopup().
// Its cross clears `open`. `size` [px]; 0: as the content needs. `cross`: whether it has one.
bool begin_modal(const char* title, bool& open, const ImVec2& size, bool cross = true);

// Begins a window beside the others; pairs with ImGui::End() in any case. Its cross clears `open`.
bool begin_dialog(const char* title, bool& open, ImGuiWindowFlags flags);

// Draws the button that closes the present dialog, as its cross and Esc do.
void close_button(const char* label, bool& open);

// Returns whether Enter was pressed in the present dialog. A text field takes Enter itself.
bool accepted();

// Notes the place of the item just drawn for programs that drive the window.
void note_place(const char* label);
void note_at(const char* label, ImVec2 place);  // notes a place that is no item's
bool noted_button(const char* label);           // draws a button and notes its place
// Middle of a noted item [px], by the window of ImGui that it is in.
struct NotedPlace {
  std::string window;
  std::string label;
  ImVec2 at;
  ImGuiID id;  // of the window, the same while the words of its name change
};
// Return what the present frame has noted so far; the first of one label, or nothing.
const std::vector<NotedPlace>& noted_places();
std::optional<ImVec2> noted_place(std::string_view window, std::string_view label);

// Places that close the topmost dialog [px].
struct DialogPlaces {
  ImVec2 cross;
  std::optional<ImVec2> button;
};
std::optional<DialogPlaces> dialog_places();

}  // namespace limpid
