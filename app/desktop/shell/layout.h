// Where the parts of the window go.
#pragma once

#include "app/desktop/base/settings.h"
#include "app/plot/plot_frame.h"

namespace limpid {

inline constexpr const char* kSidePanel = "side";  // the right one, as a window of ImGui

struct WindowSize {
  float width, height;    // [px]
  float scale;            // of text and controls
  float menu, transport;  // heights of what is always there [px]
};

struct Layout {
  ScreenRect view, transport;
  ScreenRect left, right, plots;  // where they are shown
  bool show_left = false, show_right = false, show_plots = false;
};

// Folds what there is no room for: the plots on a low window, one of the side panels on one
// narrower than 1200 px at scale 1. That is the right one until the user asks for it; the left one
// then.
class WindowLayout {
 public:
  // `settings` say what is wanted; a panel that is switched off while it is folded was asked for,
  // and is wanted again.
  Layout operator()(Settings& settings, const WindowSize& size);

 private:
  bool right_first_ = false;
  bool left_folded_ = false, right_folded_ = false;
};

}  // namespace limpid
