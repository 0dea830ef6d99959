// Legend of the colours in the picture of arm and scene.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

namespace limpid {

struct PictureLegend {
  const char* beside = nullptr;        // name of a second proxy, if there is one
  const char* cone = nullptr;          // meaning of the friction cone, if there is one
  bool slips = false;                  // shows the colour of slipping, too
  std::vector<std::string> runs = {};  // names of several runs in one picture; or none
  bool compact = false;                // short words side by side, however much room there is
};

// Draws the legend in the upper left corner of a picture, line by line. Where that would hide half
// of the picture, short words stand side by side.
void draw_picture_legend(ImDrawList& list, ImVec2 from, ImVec2 to,
                         const PictureLegend& legend = {});
// Returns the most that the legend takes from that corner on, with its margin [px].
ImVec2 picture_legend_size(ImVec2 from, ImVec2 to);

}  // namespace limpid
