#include "app/desktop/widgets/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr float kGap = 4;  // between numbers and frame [px]

double share(const ChartAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(std::max(value, 1e-300) / axis.low) / std::log(axis.high / axis.low);
}

std::string in_short(double value) {
  return value >= 1000 ? fmt::format("{:g}k", value / 1000) : fmt::format("{:g}", value);
}

struct Tick {
  double value;
  std::string label;
};

std::vector<Tick> ticks(const ChartAxis& axis, int at_most) {
  std::vector<Tick> all;
  for (const auto& [value, word] : axis.words) all.push_back({value, word});
  if (!all.empty()) return all;
  if (!axis.logarithmic) {
    const Ticks linear = nice_ticks(axis.low, axis.high, at_most);
    for (std::int64_t i = linear.first; i <= linear.last; ++i) {
      all.push_back({linear.at(i), tick_text(linear.at(i), linear.step, 0)});
    }
    return all;
  }
  for (const double value : log_ticks(axis.low, axis.high)) all.push_back({value, in_short(value)});
  return all;
}

}  // namespace

Chart::Chart(const std::string& title, const ChartAxis& x, const ChartAxis& y, float height)
    : x_(x), y_(y) {
  const float scale = current_scale();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = font(Face::small)->FontSize;
  outside_ = {at, {at.x + ImGui::GetContentRegionAvail().x, at.y + height * scale}};
  float left = y.labelled ? 34 * scale : 2;
  for (const auto& [value, word] : y.words) {
    left = std::max(left, text_size(Face::small, word).x + 2 * kGap);
  }
  inside_ = {{at.x + left, at.y + 1.4f * line},
             {outside_.max.x - 6 * scale, outside_.max.y - (x.labelled ? 1.4f * line : 4)}};
  const Palette& colours = current_palette();
  draw_clipped_text(*ImGui::GetWindowDrawList(), Face::small, at, colours.muted, title,
                    outside_.width());
  ImGui::GetWindowDrawList()->AddRectFilled(inside_.min, inside_.max, colour(colours.frame, 0.5f),
                                            3);
  draw_axes();
  ImGui::GetWindowDrawList()->PushClipRect(inside_.min, inside_.max, true);
}

Chart::~Chart() {
  ImGui::GetWindowDrawList()->PopClipRect();
  ImGui::Dummy(outside_.size());
}

ImVec2 Chart::place(ChartPoint p) const {
  const double x = std::clamp(share(x_, p.x), -5.0, 6.0), y = std::clamp(share(y_, p.y), -5.0, 6.0);
  return {inside_.min.x + inside_.width() * static_cast<float>(x),
          inside_.max.y - inside_.height() * static_cast<float>(y)};
}

ChartPoint Chart::at(ImVec2 place) const {
  const auto value = [](const ChartAxis& axis, float part) {
    const auto p = static_cast<double>(part);
    return axis.logarithmic ? axis.low * std::pow(axis.high / axis.low, p)
                            : axis.low + (axis.high - axis.low) * p;
  };
  return {value(x_, (place.x - inside_.min.x) / inside_.width()),
          value(y_, (inside_.max.y - place.y) / inside_.height())};
}

void Chart::draw_axes() const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const Palette& colours = current_palette();
  const float line = font(Face::small)->FontSize;
  const auto at_most = [](float room, float each) {
    return std::max(3, static_cast<int>(room / each));
  };
  for (const Tick& tick : ticks(x_, at_most(inside_.width(), 3.5f * line))) {
    const float x = std::round(place({tick.value, y_.low}).x);
    draw.AddLine({x, inside_.min.y}, {x, inside_.max.y}, colour(colours.grid));
    if (!x_.labelled) continue;
    const float half = text_size(Face::small, tick.label).x / 2;
    const float left = std::clamp(x - half, outside_.min.x, outside_.max.x - 2 * half);
    draw_text(draw, Face::small, {left, inside_.max.y + 2}, colours.muted, tick.label);
  }
  for (const Tick& tick : ticks(y_, at_most(inside_.height(), 2 * line))) {
    const float y = std::round(place({x_.low, tick.value}).y);
    const bool zero = tick.value == 0;
    if (y_.labelled || zero) {
      draw.AddLine({inside_.min.x, y}, {inside_.max.x, y},
                   colour(zero ? colours.axis : colours.grid));
    }
    if (!y_.labelled) continue;
    const float width = text_size(Face::small, tick.label).x;
    draw_text(draw, Face::small, {inside_.min.x - width - kGap, y - line / 2}, colours.muted,
              tick.label);
  }
}

void Chart::line(const std::vector<ChartPoint>& points, ImU32 colour, float width) const {
  std::vector<ImVec2> placed;
  placed.reserve(points.size());
  for (const ChartPoint& p : points) placed.push_back(place(p));
  ImGui::GetWindowDrawList()->AddPolyline(placed.data(), static_cast<int>(placed.size()), colour, 0,
                                          width * current_scale());
}

void Chart::dashes(const std::vector<ChartPoint>& points, ImU32 colour) const {
  constexpr int kEvery = 2;
  for (std::size_t i = 0; i + 1 < points.size(); i += kEvery) {
    ImGui::GetWindowDrawList()->AddLine(place(points[i]), place(points[i + 1]), colour,
                                        1.4f * current_scale());
  }
}

void Chart::text(ImVec2 at, const std::string& words, ImU32 colour, bool right) const {
  ImFont* small = font(Face::small);
  const ImVec2 size = text_size(Face::small, words);
  const float edge = 3 * current_scale();
  const float x = std::clamp(right ? at.x - size.x : at.x, inside_.min.x + edge,
                             std::max(inside_.min.x + edge, inside_.max.x - size.x - edge));
  const float y = std::clamp(at.y, inside_.min.y + 1, inside_.max.y - size.y - 1);
  ImGui::GetWindowDrawList()->AddText(small, small->FontSize, {std::round(x), std::round(y)},
                                      colour, words.c_str());
}

}  // namespace limpid
