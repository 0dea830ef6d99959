#include "app/desktop/experiments/sweep_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/widgets/chart.h"
#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/colour_scale.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"
#include "app/sweep/read_axes.h"
#include "app/sweep/sweep_map.h"

namespace limpid {
namespace {

struct MapMouse {
  ScreenRect inside;              // place of the map
  const MapSpot* spot = nullptr;  // spot under the mouse
  double y = 0;                   // of the mouse, on the map's axis
  bool clicked = false;
};

// Returns the colour of a value, or of the i-th line.
ImU32 map_colour(const SweepMap& map, double value);
Rgb map_line_colour(std::size_t line);

constexpr float kScaleWidth = 74, kBarWidth = 14;  // at scale 1 [px]
constexpr float kReach = 14;        // largest distance of the mouse from a dot [px at scale 1]
constexpr float kLeastMarked = 12;  // smallest side of a cell whose point is marked [px at scale 1]
constexpr int kScaleSteps = 32;

// Axis of the chart, its numbers divided by a power of ten that keeps them short.
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
  side.label = scaled_label(label, exponent);
  return side;
}

Side side_of(const SweepAxis& axis, std::pair<double, double> range) {
  if (axis.words.empty()) {
    return side_of(range, axis.logarithmic, label_of(words_of_axis(axis), axis.unit));
  }
  Side side{{range.first, range.second}, words_of_axis(axis), 1};
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
    if (map_.kind == SweepMap::Kind::cells) {
      draw_cells();
      draw_marks();
    }
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
    return side_of(map_.y_range, false, label_of(words_of_measure(column_.name), column_.unit));
  }

  ImVec2 place(double x, double y) const { return chart_.place({x / x_.unit, y / y_.unit}); }

  ImU32 ink_of(const MapSpot& spot) const { return map_colour(map_, spot.cell.value); }

  // Draws cells of one colour in a column as one rectangle.
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

  // Marks where the points of cells were computed, unless these are too small.
  void draw_marks() const {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float scale = current_scale();
    for (const MapSpot& spot : map_.spots) {
      const ImVec2 low = place(spot.cell.x_low, spot.cell.y_low);
      const ImVec2 high = place(spot.cell.x_high, spot.cell.y_high);
      if (std::min(high.x - low.x, low.y - high.y) < kLeastMarked * scale) return;
      if (!spot.there()) continue;
      const ImVec2 at = place(spot.x, spot.y);
      draw.AddCircleFilled(at, 2.6f * scale, IM_COL32(255, 255, 255, 200), 12);
      draw.AddCircleFilled(at, 1.6f * scale, IM_COL32(0, 0, 0, 255), 12);
    }
  }

  // Draws a line on a darker band, so that it is seen on every colour.
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

  // Returns the distance of the mouse from a spot: from a dot, or sideways from a curve.
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
    if (mouse.spot != nullptr) mark(*mouse.spot);
    return mouse;
  }

  void mark(const MapSpot& spot) const {
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
      if (std::isfinite(spot.y))
        draw.AddCircleFilled(place(spot.x, spot.y), 3 * current_scale(), text, 12);
    }
  }

  const SweepMap& map_;
  const SweepPlan& plan_;
  const SweepColumn& column_;
  Side x_, y_;
  Chart chart_;
};

// Number on the colour scale, at the part of the scale that lies below it.
struct ScaleMark {
  float part;
  std::string text;
};

double part_of(const SweepMap& map, double value) {
  const auto [low, high] = map.value_range;
  if (map.log_values) return std::log(value / low) / std::log(high / low);
  return (value - low) / (high - low);
}

// Returns the numbers of the colour scale, and adds their common divisor to the label.
std::vector<ScaleMark> scale_marks(const SweepMap& map, int at_most, std::string& label) {
  std::vector<ScaleMark> marks;
  const auto [low, high] = map.value_range;
  if (map.log_values) {
    for (const double x : log_ticks(low, high)) {
      marks.push_back({static_cast<float>(part_of(map, x)), fmt::format("{:g}", x)});
    }
    return marks;
  }
  const int exponent = common_exponent(low, high);
  const double unit = std::pow(10, exponent);
  label = scaled_label(label, exponent);
  const Ticks ticks = nice_ticks(low / unit, high / unit, at_most);
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    marks.push_back({static_cast<float>(part_of(map, ticks.at(i) * unit)),
                     tick_text(ticks.at(i), ticks.step, 0)});
  }
  return marks;
}

// Draws the colour scale, as high as `room`: numbers at its right, its name above, ending at
// `right`.
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
  std::string label = label_of(words_of_measure(column.name), column.unit);
  const int at_most = std::max(2, static_cast<int>(room.height() / (3 * line)));
  for (const ScaleMark& mark : scale_marks(map, at_most, label)) {
    draw_text(draw, Face::small,
              {room.max.x + 5 * current_scale(), room.max.y - mark.part * room.height() - line / 2},
              colours.muted, mark.text);
  }
  const float wide = text_size(Face::small, label).x;
  draw_text(draw, Face::small, {right - wide, room.min.y - 1.4f * line}, colours.muted, label);
}

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

// Draws at the cursor of the open ImGui window: axes, map, lines of theory, and the colour scale at
// the right.
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

constexpr float kChoice = 12;  // width of a list [em]
constexpr float kSlider = 10;  // width of a slider [em]
constexpr float kNumber = 4;   // width of the number beside a slider [em]
constexpr const char* kClose = "Close (Esc)";
constexpr float kLeastMap = 120;  // least height of the map [px at scale 1]

// Draws a list of names; returns the index chosen. A name may be wider than the list.
template <class Name>
std::size_t choose(const char* id, std::size_t chosen, std::size_t count, const Name& name) {
  const std::string shown = name(chosen);
  if (!ImGui::BeginCombo(id, shown.c_str())) {
    tooltip(shown.c_str());
    return chosen;
  }
  for (std::size_t i = 0; i < count; ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable(name(i).c_str(), i == chosen)) chosen = i;
    ImGui::PopID();
  }
  ImGui::EndCombo();
  return chosen;
}

void label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(colour_vector(current_palette().muted), "%s", text);
  ImGui::SameLine();
}

// Draws the choice of measure and axes.
void draw_choosers(const OpenedSweep& sweep, MapChoice& choice) {
  const SweepPlan& plan = *sweep.plan;
  const float width = kChoice * ImGui::GetFontSize();
  const auto axis_name = [&](std::size_t a) { return words_of_axis(plan.axes[a]); };
  ImGui::SetNextItemWidth(width);
  choice.column =
      choose("##measure", choice.column, sweep.table.columns.size(),
             [&](std::size_t c) { return words_of_measure(sweep.table.columns[c].name); });
  tooltip(sweep.table.columns[choice.column].what.c_str());
  ImGui::SameLine();
  label("over");
  const std::size_t before = choice.x;
  ImGui::SetNextItemWidth(width);
  choice.x = choose("##x", choice.x, plan.axes.size(), axis_name);
  tooltip("The setting on the map's horizontal axis");
  if (!choice.y) return;
  if (*choice.y == choice.x) choice.y = before;
  ImGui::SameLine();
  label("and");
  ImGui::SetNextItemWidth(width);
  const std::size_t y = choose("##y", *choice.y, plan.axes.size(), axis_name);
  tooltip("The setting on the map's vertical axis");
  if (y == choice.x) choice.x = *choice.y;
  choice.y = y;
}

// Draws the map's place on all other axes of a grid.
void draw_places(const SweepPlan& plan, MapChoice& choice) {
  const float em = ImGui::GetFontSize();
  bool first = true;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    if (a == choice.x || a == choice.y || axis.spread != Spread::grid) continue;
    if (axis.values.size() < 2) continue;
    const std::string words = words_of_axis(axis);
    const std::string name = axis.words.empty() ? label_of(words, axis.unit) : words;
    const float width = (axis.words.empty() ? kSlider : kChoice) * em;
    const float all = ImGui::CalcTextSize(name.c_str()).x + width + (1 + kNumber) * em;
    if (!first) flow(all);
    first = false;
    ImGui::BeginGroup();
    ImGui::PushID(static_cast<int>(a));
    label(name.c_str());
    ImGui::SetNextItemWidth(width);
    if (axis.words.empty()) {
      auto at = static_cast<int>(choice.place[a]);
      const auto last = static_cast<int>(axis.values.size()) - 1;
      if (ImGui::SliderInt("##at", &at, 0, last, "",
                           ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
        choice.place[a] = static_cast<std::size_t>(at);
      }
      ImGui::SameLine();
      ImGui::TextUnformatted(value_text(axis, choice.place[a]).c_str());
    } else {
      choice.place[a] = choose("##at", choice.place[a], axis.values.size(),
                               [&](std::size_t i) { return value_text(axis, i); });
    }
    ImGui::PopID();
    ImGui::EndGroup();
  }
}

void value_row(const std::string& name, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::TextColored(colour_vector(current_palette().muted), "%s", name.c_str());
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

std::string number_text(const SweepColumn& column, double value) {
  if (!std::isfinite(value)) return "-";
  if (column.unit == "yes/no") return value == 1 ? "yes" : "no";
  return fmt::format("{:.6g}{}", value, column.unit == "-" ? "" : " " + column.unit);
}

void draw_measured(const OpenedSweep& sweep, const SweepMap& map, const MapSpot& spot) {
  const SweepTable& table = sweep.table;
  if (!spot.there()) return value_row("", "not computed yet");
  if (spot.count > 1 || !table.done[spot.point]) {
    const SweepColumn& column = table.columns[map.choice.column];
    const std::string unit = column.unit == "-" || column.unit == "yes/no" ? "" : " " + column.unit;
    return value_row(words_of_measure(column.name),
                     fmt::format("{:.6g}{}, the mean of {}", spot.cell.value, unit, spot.count));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    value_row(words_of_measure(table.columns[c].name),
              number_text(table.columns[c], table.at(spot.point, c)));
  }
}

// Draws the values of the point under the mouse.
void draw_values(const OpenedSweep& sweep, const SweepMap& map, const MapMouse& mouse) {
  const SweepPlan& plan = *sweep.plan;
  const SweepPoint point = point_of(plan, mouse.spot->point);
  ImGui::BeginTooltip();
  if (ImGui::BeginTable("values", 2, ImGuiTableFlags_SizingFixedFit)) {
    value_row("point", fmt::format("{}", mouse.spot->point));
    for (std::size_t a = 0; a < plan.axes.size(); ++a) {
      const SweepAxis& axis = plan.axes[a];
      const bool plain = axis.unit == "-" || !axis.words.empty();
      value_row(words_of_axis(axis),
                value_text(axis, point.place[a]) + (plain ? std::string() : " " + axis.unit));
    }
    draw_measured(sweep, map, *mouse.spot);
    if (plan.boundary && map.choice.column < 2) {
      value_row("here, " + words_of_axis(plan.boundary->axis), fmt::format("{:.4g}", mouse.y));
    }
    ImGui::EndTable();
  }
  ImGui::EndTooltip();
}

void swatch(ImU32 fill, const std::string& text, bool dashed, bool line) {
  const float high = ImGui::GetTextLineHeight(), wide = line ? 1.6f * high : 0.8f * high;
  flow(wide + ImGui::CalcTextSize(text.c_str()).x + 2 * high);
  ImGui::BeginGroup();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float middle = std::round(at.y + high / 2);
  if (!line) {
    draw.AddRectFilled({at.x, at.y + 0.15f * high}, {at.x + wide, at.y + 0.95f * high}, fill, 2);
  }
  for (int i = 0; line && i < (dashed ? 2 : 1); ++i) {
    const float part = wide / (dashed ? 3 : 1), from = at.x + 2 * part * static_cast<float>(i);
    draw.AddLine({from, middle}, {from + part, middle}, fill, 2 * current_scale());
  }
  ImGui::Dummy({wide, high});
  ImGui::SameLine(0, 0.4f * high);
  ImGui::TextUnformatted(text.c_str());
  ImGui::EndGroup();
}

// Draws how far the table is filled, and the meaning of colours and lines.
void draw_legend(const SweepMap& map, const OpenedSweep& sweep) {
  const SweepTable& table = sweep.table;
  const std::uint64_t done = table.count();
  const std::string count =
      fmt::format("{} of {} points{}", done, table.points(), table.complete() ? "" : ", filling");
  ImGui::TextColored(colour_vector(current_palette().muted), "%s", count.c_str());
  if (const std::uint64_t failed = diverged_points(table); failed > 0) {
    ImGui::SameLine();
    ImGui::TextColored(colour_vector(current_palette().broken), "%s",
                       fmt::format("{} diverged", failed).c_str());
  }
  const SweepColumn& column = table.columns[map.choice.column];
  if (map.yes_no && map.kind != SweepMap::Kind::curve) {
    swatch(map_colour(map, 1), words_of_measure(column.name) + ": yes", false, false);
    swatch(map_colour(map, 0), "no", false, false);
  }
  for (std::size_t i = 0; i < map.lines.size(); ++i) {
    swatch(colour(map_line_colour(i)), map.lines[i].label,
           map.lines[i].style == Series::Style::dashed, true);
  }
}

// Draws the effect of a click, the progress of loading, or an obstacle; and the closing button.
void draw_state(const OpenedSweep& sweep, Playback& playback, bool& open) {
  const Palette& colours = current_palette();
  const float left = ImGui::GetCursorPosX();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(kClose).x -
                       2 * ImGui::GetStyle().FramePadding.x);
  close_button(kClose, open);
  const ImVec2 at = ImGui::GetItemRectMin();
  ImGui::SameLine();
  ImGui::SetCursorPosX(left);
  ImGui::PushClipRect({ImGui::GetWindowPos().x, at.y},
                      {at.x - ImGui::GetStyle().ItemSpacing.x, ImGui::GetItemRectMax().y}, true);
  if (playback.loading()) {
    progress_bar(playback.loading_part(), 22 * ImGui::GetFontSize(), playback.what());
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) playback.cancel_loading();
    return ImGui::PopClipRect();
  }
  ImGui::AlignTextToFramePadding();
  if (!sweep.why_no_run.empty()) {
    ImGui::TextColored(colour_vector(colours.broken),
                       "The points of this sweep cannot be run again: %s",
                       sweep.why_no_run.c_str());
  } else if (sweep.build != hex(build_digest())) {
    ImGui::TextColored(
        colour_vector(colours.broken),
        "This table is from another build of limpid (%s): a point run again may differ.",
        sweep.build.c_str());
  } else {
    ImGui::TextColored(colour_vector(colours.muted),
                       "Dots mark computed points. A click runs the point again and plays it; F6 "
                       "returns to the map.");
  }
  ImGui::PopClipRect();
}

// Draws the work on the sweep that is shown, or on another one, with what can be done about it.
// Returns whether another sweep is asked for.
bool draw_work(SweepController& controller) {
  const SweepRunner& runner = controller.runner();
  const bool waits = controller.may_go_on();  // asks for files
  if (runner.busy()) {
    const auto points = static_cast<double>(std::max<std::uint64_t>(runner.points(), 1));
    progress_bar(static_cast<double>(runner.done()) / points, 22 * ImGui::GetFontSize(),
                 runner.under_way());
    ImGui::SameLine();
    ImGui::BeginDisabled(runner.stopping());
    if (noted_button("Stop")) controller.stop();
    ImGui::EndDisabled();
  } else if (waits) {
    if (noted_button("Go on")) controller.go_on();
    tooltip("Computes the points that are missing.");
  }
  if (runner.busy() || waits) ImGui::SameLine();
  const bool anew = noted_button("New sweep...");
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(colour_vector(current_palette().muted), "%s",
                     controller.sweep()->file.parent_path().c_str());
  return anew;
}

MapRequest draw_contents(SweepController& controller, Playback& playback, bool& open) {
  const OpenedSweep& sweep = *controller.sweep();
  MapChoice choice = controller.choice();
  draw_choosers(sweep, choice);
  draw_places(*sweep.plan, choice);
  controller.choose(choice);
  const SweepMap* map = controller.map();
  if (map == nullptr) return {};
  const float below = ImGui::GetTextLineHeightWithSpacing() +
                      2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
  ImVec2 size = ImGui::GetContentRegionAvail();
  size.y = std::max(size.y - below, kLeastMap * current_scale());
  const MapMouse mouse = draw_sweep_map(*map, sweep, size);
  controller.on_screen = {mouse.inside, {}};
  draw_legend(*map, sweep);
  if (draw_work(controller)) return {.anew = true};
  draw_state(sweep, playback, open);
  if (mouse.spot == nullptr) return {};
  controller.on_screen->pointed_at = mouse.spot->point;
  draw_values(sweep, *map, mouse);
  if (!mouse.clicked || playback.loading()) return {};
  if (!sweep.plan->boundary) return {.point = mouse.spot->point};
  if (map->choice.column < 2) return {.point = mouse.spot->point, .at = mouse.y};
  const double found = sweep.table.at(mouse.spot->point, 0);
  return {.point = mouse.spot->point,
          .at = std::isfinite(found) ? found : sweep.plan->boundary->axis.values.front()};
}

}  // namespace

MapRequest draw_sweep_panel(SweepController& controller, Playback& playback, bool& open) {
  controller.on_screen.reset();
  if (!open) return {};
  MapRequest wish;
  const ImVec2 room = ImGui::GetMainViewport()->WorkSize;
  ImGui::SetNextWindowPos(ImGui::GetMainViewport()->GetWorkCenter(), ImGuiCond_Always,
                          {0.5f, 0.5f});
  ImGui::SetNextWindowSize({0.94f * room.x, 0.94f * room.y}, ImGuiCond_Always);
  const std::string title = controller.sweep()
                                ? fmt::format("Sweep: {}###sweep", controller.sweep()->plan->title)
                                : "Sweep###sweep";
  if (begin_dialog(title.c_str(), open, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove)) {
    if (controller.sweep()) {
      wish = draw_contents(controller, playback, open);
    } else {
      ImGui::TextUnformatted(controller.loading() ? "loading the table ..." : "No sweep is open.");
      wish.anew = noted_button("New sweep...");
      ImGui::SameLine();
      close_button(kClose, open);
    }
  }
  ImGui::End();
  return wish;
}

}  // namespace limpid
