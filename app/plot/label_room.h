// Room for the labels inside a plot: each takes a place, and none lies on another one.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "app/plot/plot_canvas.h"

namespace limpid {

class LabelRoom {
 public:
  using Box = PlotCanvas::Box;  // [px]

  explicit LabelRoom(const Box& area) : area_(area) {}

  bool has(const Box& box) const {
    return box.left >= area_.left && right(box) <= right(area_) && box.top >= area_.top &&
           bottom(box) <= bottom(area_) &&
           std::ranges::none_of(taken_, [&](const Box& other) { return overlap(box, other); });
  }
  void take(const Box& box) { taken_.push_back(box); }
  // Takes the first of these places that has room, and returns it.
  std::optional<Box> take_first(std::span<const Box> places) {
    const auto found = std::ranges::find_if(places, [&](const Box& box) { return has(box); });
    if (found == places.end()) return std::nullopt;
    take(*found);
    return *found;
  }

  // Returns places for a label of a level line at `y`, the best first: above and below it, at the
  // right end, at the left end and in the middle.
  std::array<Box, 6> beside_level(double y, double width, double height, double gap) const {
    const double end = right(area_) - width - gap, begin = area_.left + gap;
    const double above = y - height - 1, below = y + 1;
    const double middle = (begin + end) / 2;
    return {{{end, above, width, height},
             {end, below, width, height},
             {begin, above, width, height},
             {begin, below, width, height},
             {middle, above, width, height},
             {middle, below, width, height}}};
  }

 private:
  static double right(const Box& box) { return box.left + box.width; }
  static double bottom(const Box& box) { return box.top + box.height; }
  static bool overlap(const Box& a, const Box& b) {
    return a.left < right(b) && b.left < right(a) && a.top < bottom(b) && b.top < bottom(a);
  }

  Box area_;
  std::vector<Box> taken_;
};

}  // namespace limpid
