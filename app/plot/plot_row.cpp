#include "app/plot/plot_row.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limpid {
namespace {

// Least sizes at scale 1 [px].
constexpr float kLeastWidth = 190, kLeastCross = 160, kLeastRowHeight = 125;
constexpr float kCrossShape = 1.25f;  // width over height

float least_width(PlotKind kind, float scale) {
  return scale * (kind == PlotKind::cross ? kLeastCross : kLeastWidth);
}

float needed(std::span<const PlotKind> row, float gap, float scale) {
  return std::accumulate(row.begin(), row.end(), -gap, [&](float sum, PlotKind kind) {
    return sum + gap + least_width(kind, scale);
  });
}

void place_row(std::span<const PlotKind> row, ScreenRect at, float gap, float scale,
               std::vector<ScreenRect>& places) {
  const auto crosses = static_cast<float>(std::ranges::count(row, PlotKind::cross));
  const auto count = static_cast<float>(row.size());
  const float whole = at.width() - gap * (count - 1), equal = whole / count;
  const float cross =
      crosses == count ? equal
                       : std::clamp(kCrossShape * at.height(), least_width(PlotKind::cross, scale),
                                    std::max(least_width(PlotKind::cross, scale), equal));
  const float other = crosses == count ? 0 : (whole - crosses * cross) / (count - crosses);
  float x = at.min.x;
  for (const PlotKind kind : row) {
    const float right = x + (kind == PlotKind::cross ? cross : other);
    places.push_back({{std::round(x), at.min.y}, {std::round(right), at.max.y}});
    x = right + gap;
  }
}

}  // namespace

PlotPlaces place_plots(const std::vector<PlotKind>& kinds, ImVec2 room, float gap, float scale) {
  PlotPlaces all{.places = {}, .width = room.x};
  if (kinds.empty()) return all;
  const std::span<const PlotKind> whole(kinds);
  const bool two = needed(whole, gap, scale) > room.x && kinds.size() > 1 &&
                   room.y >= 2 * kLeastRowHeight * scale + gap;
  const std::size_t first = two ? (kinds.size() + 1) / 2 : kinds.size();
  all.width = std::max(
      {room.x, needed(whole.first(first), gap, scale), needed(whole.subspan(first), gap, scale)});
  const float height = two ? std::floor((room.y - gap) / 2) : room.y;
  place_row(whole.first(first), {{0, 0}, {all.width, height}}, gap, scale, all.places);
  if (two) {
    place_row(whole.subspan(first), {{0, height + gap}, {all.width, room.y}}, gap, scale,
              all.places);
  }
  return all;
}

}  // namespace limpid
