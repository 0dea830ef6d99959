// What stands over the picture as long as it is so, and cannot be missed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/desktop/base/act.h"
#include "app/plot/plot_frame.h"

namespace limpid {

struct Banner {
  struct Button {
    const char* label;
    const char* command;  // its id
  };
  const char* id;  // of its window
  std::string text;
  bool bad = false;
  std::vector<Button> buttons = {};
};

// One below the other from the top of the view on, clear of what it shows at its `signs`. Returns
// the part of the view that they and the signs take.
ScreenRect draw_banners(std::span<const Banner> banners, ScreenRect view, ScreenRect signs,
                        const Act& act);

}  // namespace limpid
