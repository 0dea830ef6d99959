// Widgets: small parts of panels.
#pragma once

#include <imgui.h>

#include <string>

#include "app/plot/plot_frame.h"
#include "app/style/words.h"

namespace limpid {

// Returns the text with small letters, of those of ASCII.
std::string small_letters(std::string text);
// Returns whether a text has this part, in small or capital letters.
bool has_part(const std::string& text, const std::string& part);

// Draws a border between panels. Dragging it changes `size` by the mouse's motion along one axis,
// in `direction`, between `least` and `most` [px at scale 1].
void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most);
// Draws a small tab at the view's edge that folds a panel away, or brings it back.
void fold_tab(const char* name, ScreenRect rect, ImGuiDir arrow, const char* help, bool& wanted);

// Begins a panel's frame without a title bar; pairs with ImGui::End(). `led`: keys lead through it.
void begin_panel(const char* name, ScreenRect rect, bool led = false);
// Begins a part of a panel that folds; returns whether it is open.
bool section(const char* name, bool open_at_first);
// Draws a small heading inside a panel.
void heading(const char* text);
// Draws a label in the muted colour and a value; red with `broken` as tooltip unless that is empty.
void read_out(const char* label, const std::string& value, const std::string& broken = {},
              const char* help = nullptr);
// Goes on beside the last item, or below it if there is no room for `width` more [px]; the second
// for a button, or whatever has a box before its words.
void flow(float width);
void flow(const char* words);
// Draws an edge of this colour at the foot of the last button.
void underline_button(Rgb rgb);
// Draws a bar filled to `part`, 0 to 1, with a text on it, by default the part. `width` [px]; 0:
// all there is.
void progress_bar(double part, float width, std::string text = {});

// Arrow keys in a list that is drawn item by item; Enter takes the item they are at. A text field
// beside a list of one column keeps left and right.
class ListKeys {
 public:
  void forget() { at_ = kNone; }
  // Moves by the keys pressed. To be called before the items; `count` is that of the last frame, in
  // rows of `columns`.
  void move(int count, int columns = 1);
  // Returns whether the keys are at the next item, counted from 0. Scrolls to it.
  bool at(int item);
  // Returns whether Enter was pressed on that item.
  bool taken(int item) const;

 private:
  static constexpr int kNone = -1;
  int at_ = kNone;
  bool moved_ = false;  // the list has not scrolled there yet
};

}  // namespace limpid
