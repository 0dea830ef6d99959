#include "app/desktop/plots/plots_panel.h"

#include <utility>

#include "app/desktop/plots/plot_chooser.h"
#include "app/desktop/widgets/widgets.h"
#include "app/plot/plot_row.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

// Draws a panel without plots.
PlotsRequest draw_no_plots() {
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const char* text = "Add a plot (N)";
  const ImVec2 size(ImGui::CalcTextSize(text).x + 3 * ImGui::GetFontSize(), 0);
  ImGui::SetCursorPos(
      {ImGui::GetCursorPosX() + 0.5f * (room.x - size.x), ImGui::GetCursorPosY() + 0.4f * room.y});
  return ImGui::Button(text, size) ? PlotsRequest{PlotWish::add} : PlotsRequest{};
}

// Returns the key of a channel that was dropped into this room; empty without one.
std::string dropped_into(ImVec2 at, ImVec2 size) {
  ImGui::SetCursorPos(at);
  ImGui::Dummy(size);
  if (!ImGui::BeginDragDropTarget()) return "";
  std::string key;
  if (const ImGuiPayload* payload = ImGui::AcceptDragDropPayload(kDraggedChannel)) {
    key.assign(static_cast<const char*>(payload->Data),
               static_cast<std::size_t>(payload->DataSize));
  }
  ImGui::EndDragDropTarget();
  return key;
}

}  // namespace

PlotsRequest draw_plots(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect rect) {
  PlotsRequest wish;
  begin_panel("plots", rect);
  stage.group.begin_frame(stage.history,
                          player != nullptr ? std::optional(player->row_time()) : std::nullopt);
  if (stage.plots.empty()) wish = draw_no_plots();
  std::vector<PlotKind> kinds;
  for (const Plot& plot : stage.plots) kinds.push_back(plot.spec().kind);
  ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  PlotPlaces at = place_plots(kinds, room, gap, current_scale());
  const bool scrolls = at.width > room.x;
  if (scrolls) {
    room.y -= ImGui::GetStyle().ScrollbarSize;
    at = place_plots(kinds, room, gap, current_scale());
  }
  ImGui::BeginChild(
      "row", {0, 0}, false,
      scrolls ? ImGuiWindowFlags_AlwaysHorizontalScrollbar : ImGuiWindowFlags_NoScrollbar);
  const ImVec2 origin = ImGui::GetCursorPos();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const ScreenRect& place = at.places[i];
    const ImVec2 from(origin.x + place.min.x, origin.y + place.min.y);
    ImGui::SetCursorPos(from);
    const PlotEvents events = stage.plots[i].draw(stage.history, stage.group, place.size(), saving);
    if (events.playback && player != nullptr) player->seek(*events.playback);
    if (events.range) {
      stage.group.select(PlotRange{events.range->start, events.range->stop, i});
    } else if (events.unselect) {
      stage.group.select(std::nullopt);
    }
    if (events.wish != PlotWish::none) wish = {events.wish, i};
    if (auto key = dropped_into(from, place.size()); !key.empty()) wish = {{}, i, std::move(key)};
  }
  ImGui::EndChild();
  ImGui::End();
  return wish;
}

}  // namespace limpid
