// Layout of the window's parts.
#pragma once

#include "app/desktop/base/settings.h"
#include "app/plot/plot_frame.h"

namespace limpid {

inline constexpr const char* kSidePanel = "side";  // the right panel, as a window of ImGui

struct WindowSize {
  float width, height;    // [px]
  float scale;            // of text and controls
  float menu, transport;  // heights of menu bar and transport bar [px]
};

struct Layout {
  ScreenRect view, transport;
  ScreenRect left, right, plots;  // if they are shown
  bool show_left = false, show_right = false, show_plots = false;
};

// Folds parts without room: the plots on a low window, and a side panel on one narrower than 1200
// px at scale 1. The right panel folds first; once the user asks for it, the left one.
class WindowLayout {
 public:
  // Returns the layout for `settings`. Switching a panel off while it is folded asks for it: it is
  // switched on again.
  Layout operator()(Settings& settings, const WindowSize& size);

 private:
  bool right_first_ = false;
  bool left_folded_ = false, right_folded_ = false;
};

}  // namespace limpid
