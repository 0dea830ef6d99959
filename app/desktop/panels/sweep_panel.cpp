#include "app/desktop/panels/sweep_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/sweep/axis_cells.h"

namespace limpid {
namespace {

constexpr float kChoice = 12;  // width of a list [em]
constexpr float kSlider = 10;  // [em]
constexpr float kNumber = 4;   // beside it [em]
constexpr const char* kClose = "Close (Esc)";
constexpr float kLeastMap = 120;  // [px at scale 1]

// Beside what was drawn last, or below it where there is no room for `width` more.
void flow(float width) {
  const float end = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x;
  if (end + ImGui::GetStyle().ItemSpacing.x + width < ImGui::GetWindowContentRegionMax().x) {
    ImGui::SameLine();
  }
}

// One of some; returns which.
template <class Name>
std::size_t choose(const char* id, std::size_t chosen, std::size_t count, const Name& name) {
  if (!ImGui::BeginCombo(id, name(chosen).c_str())) return chosen;
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

// Measure and axes.
void draw_choosers(const OpenedSweep& sweep, MapChoice& choice) {
  const SweepPlan& plan = *sweep.plan;
  const float width = kChoice * ImGui::GetFontSize();
  const auto axis_name = [&](std::size_t a) { return plan.axes[a].name; };
  ImGui::SetNextItemWidth(width);
  choice.column = choose("##measure", choice.column, sweep.table.columns.size(),
                         [&](std::size_t c) { return sweep.table.columns[c].name; });
  tooltip(sweep.table.columns[choice.column].what.c_str());
  ImGui::SameLine();
  label("over");
  const std::size_t before = choice.x;
  ImGui::SetNextItemWidth(width);
  choice.x = choose("##x", choice.x, plan.axes.size(), axis_name);
  tooltip("The axis from left to right");
  if (!choice.y) return;
  if (*choice.y == choice.x) choice.y = before;
  ImGui::SameLine();
  label("and");
  ImGui::SetNextItemWidth(width);
  const std::size_t y = choose("##y", *choice.y, plan.axes.size(), axis_name);
  tooltip("The axis upwards");
  if (y == choice.x) choice.x = *choice.y;
  choice.y = y;
}

// Where the map lies on all other axes of a grid.
void draw_places(const SweepPlan& plan, MapChoice& choice) {
  const float em = ImGui::GetFontSize();
  bool first = true;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    const SweepAxis& axis = plan.axes[a];
    if (a == choice.x || a == choice.y || axis.spread != Spread::grid) continue;
    if (axis.values.size() < 2) continue;
    const std::string name = axis.words.empty() ? label_of(axis.name, axis.unit) : axis.name;
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
  if (!spot.there()) return value_row("", "not there yet");
  if (spot.inferred) {
    const SweepColumn& column = table.columns[map.choice.column];
    return value_row(column.name, number_text(column, spot.cell.value) + ", from those around it");
  }
  const auto row = table.rows.row_of(spot.point);
  if (spot.count > 1 || !row || !table.done[*row]) {
    const SweepColumn& column = table.columns[map.choice.column];
    const std::string unit = column.unit == "-" || column.unit == "yes/no" ? "" : " " + column.unit;
    return value_row(column.name,
                     fmt::format("{:.6g}{}, the mean of {}", spot.cell.value, unit, spot.count));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    value_row(table.columns[c].name, number_text(table.columns[c], table.at(*row, c)));
  }
}

// The point under the mouse.
void draw_values(const OpenedSweep& sweep, const SweepMap& map, const MapMouse& mouse) {
  const SweepPlan& plan = *sweep.plan;
  const SweepPoint point = point_of(plan, mouse.spot->point);
  ImGui::BeginTooltip();
  if (ImGui::BeginTable("values", 2, ImGuiTableFlags_SizingFixedFit)) {
    value_row("point", fmt::format("{}", mouse.spot->point));
    for (std::size_t a = 0; a < plan.axes.size(); ++a) {
      const SweepAxis& axis = plan.axes[a];
      const bool plain = axis.unit == "-" || !axis.words.empty();
      value_row(axis.name,
                value_text(axis, point.place[a]) + (plain ? std::string() : " " + axis.unit));
    }
    draw_measured(sweep, map, *mouse.spot);
    if (plan.boundary && map.choice.column < 2) {
      value_row("here, " + plan.boundary->axis.name, fmt::format("{:.4g}", mouse.y));
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

// How far it is filled, and what the colours and lines mean.
void draw_legend(const SweepMap& map, const OpenedSweep& sweep) {
  const SweepTable& table = sweep.table;
  const std::uint64_t done = table.count();
  const std::string count =
      fmt::format("{} of {} points{}", done, table.points(), table.complete() ? "" : ", filling");
  ImGui::TextColored(colour_vector(current_palette().muted), "%s", count.c_str());
  const SweepColumn& column = table.columns[map.choice.column];
  if (map.yes_no && map.kind != SweepMap::Kind::curve) {
    swatch(map_colour(map, 1), column.name, false, false);
    swatch(map_colour(map, 0), "not " + column.name, false, false);
  }
  for (std::size_t i = 0; i < map.lines.size(); ++i) {
    swatch(colour(map_line_colour(i)), map.lines[i].label,
           map.lines[i].style == Series::Style::dashed, true);
  }
}

// What a click does, what goes on, or what is in the way.
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
    ImGui::TextColored(colour_vector(colours.broken), "Only to be looked at: %s",
                       sweep.why_no_run.c_str());
  } else if (sweep.build != hex(build_digest())) {
    ImGui::TextColored(
        colour_vector(colours.broken),
        "Made by another build of limpid (%s): a point that is run again may differ.",
        sweep.build.c_str());
  } else {
    ImGui::TextColored(colour_vector(colours.muted),
                       "A click runs that point again and plays it; F6 comes back here.");
  }
  ImGui::PopClipRect();
}

MapRequest draw_contents(SweepController& controller, Playback& playback, bool& open) {
  const OpenedSweep& sweep = *controller.sweep();
  MapChoice choice = controller.choice();
  draw_choosers(sweep, choice);
  draw_places(*sweep.plan, choice);
  controller.choose(choice);
  const SweepMap* map = controller.map();
  if (map == nullptr) return {};
  const float below = ImGui::GetTextLineHeightWithSpacing() + ImGui::GetFrameHeightWithSpacing() +
                      ImGui::GetStyle().ItemSpacing.y;
  ImVec2 size = ImGui::GetContentRegionAvail();
  size.y = std::max(size.y - below, kLeastMap * current_scale());
  const MapMouse mouse = draw_sweep_map(*map, sweep, size);
  controller.on_screen = {mouse.inside, {}};
  draw_legend(*map, sweep);
  draw_state(sweep, playback, open);
  if (mouse.spot == nullptr) return {};
  controller.on_screen->pointed_at = mouse.spot->point;
  draw_values(sweep, *map, mouse);
  if (!mouse.clicked || playback.loading()) return {};
  if (!sweep.plan->boundary) return {mouse.spot->point, {}};
  if (map->choice.column < 2) return {mouse.spot->point, mouse.y};
  const auto row = sweep.table.rows.row_of(mouse.spot->point);
  const double found = row ? sweep.table.at(*row, 0) : std::nan("");
  return {mouse.spot->point,
          std::isfinite(found) ? found : sweep.plan->boundary->axis.values.front()};
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
      close_button(kClose, open);
    }
  }
  ImGui::End();
  return wish;
}

}  // namespace limpid
