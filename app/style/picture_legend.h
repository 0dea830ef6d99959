// What the colours in the picture of arm and scene mean.
#pragma once

#include <imgui.h>

#include <string>

namespace limpid {

struct PictureLegend {
  const char* beside = nullptr;  // who a second proxy is, if there is one
  const char* cone = nullptr;    // what the friction cone says, if there is one
  bool slips = false;            // and its colour
  // Two runs in one picture, by name; or none.
  std::string first = {}, second = {};
  bool compact = false;  // short words side by side, however much room there is
};

// In the upper left corner of a picture, line by line, or, where that would hide half of it, in
// short words side by side.
void draw_picture_legend(ImDrawList& list, ImVec2 from, ImVec2 to,
                         const PictureLegend& legend = {});
// What it takes at most, with its margin, from that corner on [px].
ImVec2 picture_legend_size(ImVec2 from, ImVec2 to);

}  // namespace limpid
