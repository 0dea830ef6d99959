// Small things that panels are made of.
#pragma once

#include <imgui.h>

#include <string>

#include "app/plot/plot_frame.h"
#include "app/style/words.h"

namespace limpid {

// What lies at the edges of panels.

// A border between panels that can be dragged: changes `size` by the mouse's motion along one axis,
// in `direction`, between `least` and `most` [px at scale 1].
void splitter(const char* name, ScreenRect rect, bool vertical, double direction, double& size,
              double least, double most);
// A small tab at the view's edge that folds a panel away, or brings it back.
void fold_tab(const char* name, ScreenRect rect, ImGuiDir arrow, const char* help, bool& wanted);

// A panel's frame without a title bar; pairs with ImGui::End().
void begin_panel(const char* name, ScreenRect rect);
// A part of a panel that folds; whether it is open.
bool section(const char* name, bool open_at_first);
// A small heading inside a panel.
void heading(const char* text);
// A label in the muted colour and a value; red with a tooltip when `broken` is not empty.
void read_out(const char* label, const std::string& value, const std::string& broken = {},
              const char* help = nullptr);
// An edge of this colour at the foot of the button just drawn.
void underline_button(Rgb rgb);
// A bar filled to `part`, 0 to 1, with a text on it; `width` [px], 0: all there is. Without a text
// it says the part.
void progress_bar(double part, float width, std::string text = {});

// Where the arrow keys have gone in a list that is drawn item by item; Enter takes that item. A
// text field beside the list keeps left, right, Home and End.
class ListKeys {
 public:
  void forget() { at_ = kNone; }
  // Before the items: there were so many in the last frame, in rows of `columns`.
  void move(int count, int columns = 1);
  // Of the item about to be drawn, counted from 0: whether the keys are at it. Scrolls there.
  bool at(int item);
  // Of that item: Enter was pressed.
  bool taken(int item) const;

 private:
  static constexpr int kNone = -1;
  int at_ = kNone;
  bool moved_ = false;  // not scrolled there yet
};

}  // namespace limpid
