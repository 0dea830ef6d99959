// A small picture of curves over two axes, for panels.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "app/plot/plot_frame.h"

namespace limpid {

struct ChartPoint {
  double x, y;
};

struct ChartAxis {
  double low = 0, high = 1;  // low < high; above 0 if logarithmic
  bool logarithmic = false;
  bool labelled = true;                                    // with numbers
  std::vector<std::pair<double, std::string>> words = {};  // in their place
};

// Draws into the ImGui window that is open, at its cursor and as wide as there is room.
class Chart {
 public:
  // `title` stands above it, and says quantity and unit. `height` of all of it [px at scale 1].
  Chart(const std::string& title, const ChartAxis& x, const ChartAxis& y, float height);
  ~Chart();
  Chart(const Chart&) = delete;
  Chart& operator=(const Chart&) = delete;

  ImVec2 place(ChartPoint p) const;   // on the screen [px]
  ChartPoint at(ImVec2 place) const;  // the other way round
  const ScreenRect& inside() const { return inside_; }
  void line(const std::vector<ChartPoint>& points, ImU32 colour, float width = 1.8f) const;
  void dashes(const std::vector<ChartPoint>& points, ImU32 colour) const;
  // In small letters, kept inside the frame. `right`: ends there instead of beginning there.
  void text(ImVec2 at, const std::string& words, ImU32 colour, bool right = false) const;

 private:
  void draw_axes() const;

  ChartAxis x_, y_;
  ScreenRect outside_, inside_;
};

}  // namespace limpid
