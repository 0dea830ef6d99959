#include "app/desktop/shell/layout.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

// Least width of the view between two panels, and least height of plots, at scale 1 [px].
constexpr float kLeastView = 300, kLeastPlots = 130;
constexpr float kBothPanels = 1200;  // a narrower window shows one side panel
// Parts of the window's height: most of the plots, unless they need more, and least above them.
constexpr float kMostPlots = 0.27f, kLeastAbovePlots = 0.4f;

}  // namespace

Layout WindowLayout::operator()(Settings& settings, const WindowSize& size) {
  const auto scaled = [&](double length) {
    return std::round(static_cast<float>(length) * size.scale);  // whole pixels: no seams
  };
  if (left_folded_ && !settings.show_left) {
    settings.show_left = true;
    right_first_ = false;
  }
  if (right_folded_ && !settings.show_right) {
    settings.show_right = right_first_ = true;
  }
  const float most = std::round(size.width / 2);
  float left = settings.show_left ? std::min(scaled(settings.left), most) : 0;
  float right = settings.show_right ? std::min(scaled(settings.right), most) : 0;
  const bool narrow =
      size.width < kBothPanels * size.scale || size.width - left - right < kLeastView * size.scale;
  left_folded_ = narrow && left > 0 && right > 0 && right_first_;
  right_folded_ = narrow && left > 0 && right > 0 && !right_first_;
  if (left_folded_) left = 0;
  if (right_folded_) right = 0;

  const float bottom = size.height - size.transport;
  const float plots =
      std::max(std::min(scaled(settings.plots), std::round(kMostPlots * size.height)),
               std::round(kLeastPlots * size.scale));
  Layout at;
  at.show_left = left > 0;
  at.show_right = right > 0;
  at.show_plots =
      settings.show_plots && bottom - plots - size.menu >= kLeastAbovePlots * size.height;
  const float middle = at.show_plots ? bottom - plots : bottom;
  at.view = {{left, size.menu}, {size.width - right, middle}};
  at.left = {{0, size.menu}, {left, middle}};
  at.right = {{size.width - right, size.menu}, {size.width, middle}};
  at.plots = {{0, middle}, {size.width, bottom}};
  at.transport = {{0, bottom}, {size.width, size.height}};
  return at;
}

}  // namespace limpid
