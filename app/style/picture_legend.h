// What the colours in the picture of arm and scene mean.
#pragma once

#include <imgui.h>

namespace limpid {

struct PictureLegend {
  const char* beside = nullptr;  // who a second proxy is, if there is one
  const char* cone = nullptr;    // what the friction cone says, if there is one
  bool slips = false;            // and its colour
};

// With its left upper corner at `at` [px].
void draw_picture_legend(ImDrawList& list, ImVec2 at, const PictureLegend& legend = {});
// What it takes at most [px].
ImVec2 picture_legend_size();

}  // namespace limpid
