// Chart: a small picture of curves over two axes, for panels.
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
  bool labelled = true;                                    // has numbers
  std::vector<std::pair<double, std::string>> words = {};  // at places of their own
};

// Draws into the open ImGui window, at its cursor and as wide as there is room.
class Chart {
 public:
  // Draws the axes. `title` stands above the chart, and says quantity and unit. `height` is that of
  // all [px at scale 1].
  Chart(const std::string& title, const ChartAxis& x, const ChartAxis& y, float height);
  ~Chart();
  Chart(const Chart&) = delete;
  Chart& operator=(const Chart&) = delete;

  ImVec2 place(ChartPoint p) const;   // [px] on the screen
  ChartPoint at(ImVec2 place) const;  // inverse of place()
  const ScreenRect& inside() const { return inside_; }
  void line(const std::vector<ChartPoint>& points, ImU32 colour, float width = 1.8f) const;
  void dashes(const std::vector<ChartPoint>& points, ImU32 colour) const;
  // Writes in small letters, kept inside the frame. `right`: `at` is the end instead of the
  // beginning.
  void text(ImVec2 at, const std::string& words, ImU32 colour, bool right = false) const;

 private:
  void draw_axes() const;

  ChartAxis x_, y_;
  ScreenRect outside_, inside_;
};

}  // namespace limpid
