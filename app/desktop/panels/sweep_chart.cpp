#include "app/desktop/panels/sweep_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/widgets/chart.h"
#include "app/study/sweep_map.h"
#include "app/style/colour_scale.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr float kScaleWidth = 74, kBarWidth = 14;  // at scale 1 [px]
constexpr float kReach = 14;  // how near the mouse has to be to a dot [px at scale 1]
constexpr int kScaleSteps = 32;

// An axis of the chart, its numbers divided by a power of ten that keeps them short.
struct Side {
  ChartAxis axis;
  std::string label;
  double unit = 1;
};

Side side_of(std::pair<double, double> range, bool logarithmic, const std::string& label) {
  Side side{{range.first, range.second, logarithmic}, label, 1};
  if (logarithmic) return side;
  const int exponent = common_exponent(range.first, range.second);
  side.unit = std::pow(10, exponent);
  side.axis.low /= side.unit;
  side.axis.high /= side.unit;
  if (exponent != 0) side.label += " " + exponent_text(exponent);
  return side;
}

Side side_of(const SweepAxis& axis, std::pair<double, double> range) {
  if (axis.words.empty()) {
    return side_of(range, axis.logarithmic, label_of(axis.name, axis.unit));
  }
  Side side{{range.first, range.second}, axis.name, 1};
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    side.axis.words.emplace_back(static_cast<double>(i), value_text(axis, i));
  }
  return side;
}

class MapPainter {
 public:
  MapPainter(const SweepMap& map, const OpenedSweep& sweep, float height)
      : map_(map),
        plan_(*sweep.plan),
        column_(sweep.table.columns[map.choice.column]),
        x_(side_of(plan_.axes[map.choice.x], map.x_range)),
        y_(upright()),
        chart_(y_.label + " over " + x_.label, x_.axis, y_.axis, height) {}

  MapMouse draw() {
    if (map_.kind == SweepMap::Kind::cells) draw_cells();
    for (std::size_t i = 0; i < map_.lines.size(); ++i) draw_line(i);
    if (map_.kind == SweepMap::Kind::dots) draw_dots();
    if (map_.kind == SweepMap::Kind::curve) draw_curve();
    return mouse();
  }

 private:
  Side upright() const {
    if (map_.choice.y) return side_of(plan_.axes[*map_.choice.y], map_.y_range);
    if (plan_.boundary && map_.choice.column < 2) {
      return side_of(plan_.boundary->axis, map_.y_range);
    }
    return side_of(map_.y_range, false, label_of(column_.name, column_.unit));
  }

  ImVec2 place(double x, double y) const { return chart_.place({x / x_.unit, y / y_.unit}); }

  ImU32 ink_of(const MapSpot& spot) const { return map_colour(map_, spot.cell.value); }

  // In each column what has one colour is one rectangle.
  void draw_cells() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const std::size_t columns = map_.spots.size() / map_.rows;
    std::vector<float> heights;
    for (std::size_t iy = 0; iy < map_.rows; ++iy) {
      heights.push_back(std::round(place(map_.spots[0].x, map_.spots[iy].cell.y_low).y));
    }
    heights.push_back(std::round(chart_.inside().min.y));
    for (std::size_t ix = 0; ix < columns; ++ix) {
      const MapSpot* column = &map_.spots[ix * map_.rows];
      const float left = std::round(place(column->cell.x_low, column->y).x);
      const float right = std::round(place(column->cell.x_high, column->y).x);
      for (std::size_t from = 0, to = 0; from < map_.rows; from = to) {
        const bool there = column[from].there();
        const ImU32 colour = there ? ink_of(column[from]) : 0;
        for (to = from + 1; to < map_.rows; ++to) {
          if (column[to].there() != there || (there && ink_of(column[to]) != colour)) break;
        }
        if (there) draw.AddRectFilled({left, heights[to]}, {right, heights[from]}, colour);
      }
    }
  }

  // On a darker band, so that it is seen on every colour.
  void stroke(const std::vector<FigurePoint>& points, Rgb rgb, float width, bool dashed) const {
    std::vector<ImVec2> run;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float scale = current_scale();
    const auto flush = [&] {
      const auto count = static_cast<int>(run.size());
      const std::size_t step = dashed ? 2 : 1;
      for (const auto& [ink, wide] :
           {std::pair{colour(current_palette().backdrop, 0.55f), 2.2f}, {colour(rgb), 0.0f}}) {
        if (!dashed) draw.AddPolyline(run.data(), count, ink, 0, (width + wide) * scale);
        for (std::size_t i = 0; dashed && i + 1 < run.size(); i += step) {
          draw.AddLine(run[i], run[i + 1], ink, (width + wide) * scale);
        }
      }
      run.clear();
    };
    for (const FigurePoint& p : points) {
      std::isfinite(p.x) && std::isfinite(p.y) ? run.push_back(place(p.x, p.y)) : flush();
    }
    flush();
  }

  void draw_line(std::size_t i) const {
    const Series& line = map_.lines[i];
    stroke(line.points, map_line_colour(i), 2, line.style == Series::Style::dashed);
  }

  void draw_dots() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (const MapSpot& spot : map_.spots) {
      if (!spot.there()) continue;
      draw.AddCircleFilled(place(spot.x, spot.y), 4 * current_scale(), ink_of(spot), 12);
    }
  }

  void draw_curve() const {
    std::vector<FigurePoint> points;
    for (const MapSpot& spot : map_.spots) points.push_back({spot.x, spot.y});
    const Rgb rgb = ink(current_palette(), Ink::proxy);
    if (plan_.axes[map_.choice.x].spread == Spread::grid) stroke(points, rgb, 2, false);
    for (const FigurePoint& p : points) {
      if (!std::isfinite(p.y)) continue;
      ImGui::GetWindowDrawList()->AddCircleFilled(place(p.x, p.y), 3 * current_scale(), colour(rgb),
                                                  12);
    }
  }

  // Of dots the nearest one; of curves the one that is nearest sideways.
  double distance(const MapSpot& spot, ImVec2 at) const {
    const ImVec2 p = place(spot.x, std::isfinite(spot.y) ? spot.y : 0);
    const bool curve = map_.kind == SweepMap::Kind::curve;
    return std::hypot(p.x - at.x, curve ? 0 : p.y - at.y);
  }

  MapMouse mouse() const {
    MapMouse mouse;
    mouse.inside = chart_.inside();
    ImGui::SetCursorScreenPos(mouse.inside.min);
    mouse.clicked = ImGui::InvisibleButton("map", mouse.inside.size());
    if (!ImGui::IsItemHovered()) return mouse;
    const ImVec2 at = ImGui::GetMousePos();
    const ChartPoint under = chart_.at(at);
    const double x = under.x * x_.unit;
    mouse.y = under.y * y_.unit;
    const double reach = map_.kind == SweepMap::Kind::curve ? HUGE_VAL : kReach * current_scale();
    double nearest = reach;
    for (const MapSpot& spot : map_.spots) {
      const FigureCell& c = spot.cell;
      if (map_.kind == SweepMap::Kind::cells) {
        if (x < c.x_low || x > c.x_high || mouse.y < c.y_low || mouse.y > c.y_high) continue;
        mouse.spot = &spot;
        break;
      }
      if (const double far = distance(spot, at); far < nearest) nearest = far, mouse.spot = &spot;
    }
    if (mouse.spot != nullptr) mark(*mouse.spot, at);
    return mouse;
  }

  void mark(const MapSpot& spot, ImVec2 at) const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImU32 text = colour(current_palette().text);
    if (map_.kind == SweepMap::Kind::cells) {
      const ImVec2 low = place(spot.cell.x_low, spot.cell.y_low);
      const ImVec2 high = place(spot.cell.x_high, spot.cell.y_high);
      draw.AddRect({low.x, high.y}, {high.x, low.y}, text, 0, 0, 1.5f * current_scale());
    } else if (map_.kind == SweepMap::Kind::dots) {
      draw.AddCircle(place(spot.x, spot.y), 6 * current_scale(), text, 16, 1.5f);
    } else {
      const float x = place(spot.x, spot.y).x;
      draw.AddLine({x, chart_.inside().min.y}, {x, chart_.inside().max.y}, text);
      draw.AddCircleFilled({x, at.y}, 3 * current_scale(), text, 12);
    }
  }

  const SweepMap& map_;
  const SweepPlan& plan_;
  const SweepColumn& column_;
  Side x_, y_;
  Chart chart_;
};

// A number of the scale, and what part of it lies below.
struct ScaleMark {
  float part;
  std::string text;
};

double part_of(const SweepMap& map, double value) {
  const auto [low, high] = map.value_range;
  if (map.log_values) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

// What the numbers are divided by is added to the label.
std::vector<ScaleMark> scale_marks(const SweepMap& map, int at_most, std::string& label) {
  std::vector<ScaleMark> marks;
  const auto [low, high] = map.value_range;
  if (map.log_values) {
    for (double x = std::pow(10, std::ceil(std::log10(low))); x <= high; x *= 10) {
      marks.push_back({static_cast<float>(part_of(map, x)), fmt::format("{:.0e}", x)});
    }
    return marks;
  }
  const int exponent = common_exponent(low, high);
  const double unit = std::pow(10, exponent);
  if (exponent != 0) label += " " + exponent_text(exponent);
  const Ticks ticks = nice_ticks(low / unit, high / unit, at_most);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    marks.push_back({static_cast<float>(part_of(map, ticks.at(i) * unit)),
                     tick_text(ticks.at(i), ticks.step, 0)});
  }
  return marks;
}

// Of the height of `room`, with its numbers at the right and its name above, which ends at `right`.
void draw_scale(const SweepMap& map, const SweepColumn& column, ScreenRect room, float right) {
  const Palette& colours = current_palette();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float line = font(Face::small)->FontSize;
  for (int i = 0; i < kScaleSteps; ++i) {
    const auto edge = [&](int k) {
      return std::round(room.max.y - room.height() * static_cast<float>(k) / kScaleSteps);
    };
    draw.AddRectFilled({room.min.x, edge(i + 1)}, {room.max.x, edge(i)},
                       colour(scale_colour((i + 0.5) / kScaleSteps)));
  }
  std::string label = label_of(column.name, column.unit);
  const int at_most = std::max(2, static_cast<int>(room.height() / (3 * line)));
  for (const ScaleMark& mark : scale_marks(map, at_most, label)) {
    draw_text(draw, Face::small,
              {room.max.x + 5 * current_scale(), room.max.y - mark.part * room.height() - line / 2},
              colours.muted, mark.text);
  }
  const float wide = text_size(Face::small, label).x;
  draw_text(draw, Face::small, {right - wide, room.min.y - 1.4f * line}, colours.muted, label);
}

}  // namespace

ImU32 map_colour(const SweepMap& map, double value) {
  const Palette& colours = current_palette();
  if (!std::isfinite(value)) return colour(colours.frame_active);
  if (map.yes_no) {
    return colour(mix(ink(colours, value == 1 ? Ink::proxy : Ink::contact), colours.panel, 0.45f));
  }
  return colour(scale_colour(part_of(map, value)));
}

Rgb map_line_colour(std::size_t line) {
  const Palette& colours = current_palette();
  constexpr std::array kInks{Ink::rerun, Ink::hand, Ink::energy};
  return line == 0 ? colours.text : ink(colours, kInks[(line - 1) % kInks.size()]);
}

MapMouse draw_sweep_map(const SweepMap& map, const OpenedSweep& sweep, ImVec2 size) {
  const bool scale = !map.yes_no && map.kind != SweepMap::Kind::curve;
  const float wide = scale ? kScaleWidth * current_scale() : 0;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::BeginChild("chart", {size.x - wide, size.y}, false, ImGuiWindowFlags_NoScrollbar);
  const MapMouse mouse = MapPainter(map, sweep, size.y / current_scale()).draw();
  ImGui::EndChild();
  if (scale) {
    const float left = at.x + size.x - wide + 10 * current_scale();
    draw_scale(
        map, sweep.table.columns[map.choice.column],
        {{left, mouse.inside.min.y}, {left + kBarWidth * current_scale(), mouse.inside.max.y}},
        at.x + size.x);
  }
  return mouse;
}

}  // namespace limpid
