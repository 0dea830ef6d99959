#include "app/desktop/plots/range_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/desktop/widgets/modal.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

std::string figure_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "\u2013";
}

void figure_cell(const std::string& text, bool head = false) {
  ImGui::TableNextColumn();
  const float room = ImGui::GetContentRegionAvail().x;
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room - width));
  head ? ImGui::TextDisabled("%s", text.c_str()) : ImGui::TextUnformatted(text.c_str());
}

}  // namespace

// Computes the figures anew only if something has changed: a range may have a minute of rows.
void RangePanel::reckon(const Plot& plot, const History& history, const PlotRange& range) {
  std::vector<int> channels;
  for (const Curve& curve : plot.spec().curves) {
    channels.push_back(curve.visible ? curve.channel : -1);
  }
  const SampleIndex first = std::max(history.first(), history.lower_bound(range.start));
  const SampleIndex end = history.lower_bound(range.stop);
  if (range == known_ && channels == channels_ && first == first_ && end == end_) return;
  known_ = range;
  first_ = first;
  end_ = end;
  channels_ = channels;
  lines_.clear();
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (channels[i] < 0) continue;
    lines_.push_back({i, figures_between(history, channels[i], range.start, range.stop)});
  }
}

void RangePanel::draw(Stage& stage, Player* player, const PlotSaving& saving, ScreenRect view) {
  PlotGroup& group = stage.group;
  if (!group.range() || group.range()->plot >= stage.plots.size()) return;
  const PlotRange range = *group.range();
  const Plot& plot = stage.plots[range.plot];
  const PlotSpec& spec = plot.spec();
  reckon(plot, stage.history, range);
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * (view.min.x + view.max.x), view.max.y - 0.5f * em},
                          ImGuiCond_Always, {0.5f, 1});
  ImGui::Begin("range", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  const double offset = stage.history.offset();
  ImGui::TextUnformatted(fmt::format("{}: {:.3f} s to {:.3f} s, {:.3f} s long", spec.title,
                                     range.start - offset, range.stop - offset,
                                     range.stop - range.start)
                             .c_str());
  if (ImGui::BeginTable("figures", 5, ImGuiTableFlags_SizingFixedFit)) {
    const std::string unit = spec.y.unit.empty() ? "" : fmt::format("[{}]", spec.y.unit);
    ImGui::TableSetupColumn("curve");
    for (const char* head : {"mean", "rms", "min", "max"}) {
      ImGui::TableSetupColumn(head, ImGuiTableColumnFlags_WidthFixed, 5 * em);
    }
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", unit.c_str());
    for (const char* head : {"mean", "rms", "min", "max"}) figure_cell(head, true);
    for (const Line& line : lines_) {
      const Curve& curve = spec.curves[line.curve];
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(curve.label.c_str());
      const RangeFigures& f = line.figures;
      for (const double value : {f.mean, f.rms, f.low, f.high}) {
        figure_cell(figure_text(value * spec.y.factor));
      }
    }
    ImGui::EndTable();
  }
  if (noted_button("Export range as CSV")) {
    const PlotPicture picture{range.start, range.stop, {}, {}};
    auto notice = fulfil(PlotWish::save_csv, spec, stage.history, picture, saving);
    if (notice && saving.beside) saving.beside([said = *notice] { return said; });
  }
  if (player != nullptr) {
    ImGui::SameLine();
    if (noted_button("Play this")) player->play_between(range.start, range.stop);
    tooltip("Plays the selected time from beginning to end. With Loop the playback repeats.");
  }
  ImGui::SameLine();
  if (noted_button("Clear (Esc)")) group.select(std::nullopt);
  ImGui::End();
}

}  // namespace limpid
