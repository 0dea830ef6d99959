#include "app/desktop/coupling/lanes_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <vector>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/ticks.h"

namespace limpid {
namespace {

constexpr float kRatios = 16;  // least width of a panel that has them [em]

void choose(const RunNames& names, std::size_t& edited) {
  const std::size_t runs = names.names.size();
  const float between = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(runs - 1);
  const float width =
      (ImGui::GetContentRegionAvail().x - between) / static_cast<float>(std::max(runs, 1UL));
  const Palette& colours = current_palette();
  for (std::size_t run = 0; run < runs; ++run) {
    if (run > 0) ImGui::SameLine();
    const bool chosen = edited == run;
    ImGui::PushID(static_cast<int>(run));
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(colours.frame_active));
    if (ImGui::Button(names.name(run).c_str(), {width, 0})) edited = run;
    if (chosen) ImGui::PopStyleColor();
    if (const int law = names.law(run); law >= 0) underline_button(law_ink(colours, law));
    tooltip(fmt::format("Click here. Then the sliders below change the run {}.", names.name(run))
                .c_str());
    ImGui::PopID();
  }
}

void cell(const std::string& text, bool muted = false) {
  ImGui::TableNextColumn();
  const float room = ImGui::GetContentRegionAvail().x;
  const float width = ImGui::CalcTextSize(text.c_str()).x;
  if (!muted) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, room - width));
  const Palette& colours = current_palette();
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(muted ? colours.muted : colours.text));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

// Returns the second over the first; empty for a gain and a loss, where it says nothing.
std::string ratio(double a, double b, double least) {
  return a * b > 0 && std::min(std::abs(a), std::abs(b)) > least ? "\xC3\x97" + three_digits(b / a)
                                                                 : "";
}

}  // namespace

void draw_lanes(const Stage& stage, LaneRows rows, std::size_t* edited, bool& overlaid,
                const Act& act) {
  const TraceChannels& channels = stage.channels();
  std::vector<std::vector<double>> values;
  for (const std::span<const double> row : rows) {
    values.emplace_back(static_cast<std::size_t>(channels.count()));
    channels.values(row, values.back());
  }
  if (edited != nullptr) choose(stage.names(), *edited);
  struct Line {
    const char* what;
    Channel channel;
    double factor, least;
  };
  constexpr std::array kLines{Line{"|x_E| mrad", Channel::error, 1e3, 0.01},
                              Line{"|f1| N m", Channel::human, 1, 1e-3},
                              Line{"|f2| N m", Channel::contact, 1, 1e-3},
                              Line{"E_c mJ", Channel::energy_total, 1e3, 0.01}};
  // Ratios have no room beside more runs, and none in a narrow panel.
  const bool ratios =
      rows.size() == 2 && ImGui::GetContentRegionAvail().x > kRatios * ImGui::GetFontSize();
  std::vector<const char*> widest(rows.size(),
                                  "\xE2\x88\x92"
                                  "8888.8");
  if (ratios) {
    widest.push_back(
        "\xC3\x97"
        "0.888");
  }
  if (ImGui::BeginTable("runs", 1 + static_cast<int>(widest.size()))) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
    for (const char* text : widest) {
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize(text).x);
    }
    for (const Line& line : kLines) {
      const auto at = [&](std::size_t run) {
        return line.factor * values[run][static_cast<std::size_t>(line.channel)];
      };
      cell(line.what, true);
      for (std::size_t run = 0; run < rows.size(); ++run) {
        cell(fixed_text(at(run), std::abs(at(run)) < 10 ? 2 : 1));
      }
      if (ratios) cell(ratio(at(0), at(1), line.least));
    }
    ImGui::EndTable();
  }
  ImGui::Checkbox("all in one picture", &overlaid);
  tooltip(
      "Draws the other runs in other shades in the picture of the first run, not in separate "
      "pictures beside it (Shift+B).");
  if (edited != nullptr) {
    if (rows.size() < kMostLanes) {
      flow("+ run");
      if (ImGui::SmallButton("+ run")) act("session.add_run");
      tooltip("Adds another coupling. The same hand moves it (Ctrl+B).");
    }
    flow("- run");
    if (ImGui::SmallButton("\xE2\x88\x92 run")) act("session.drop_run");
    tooltip("Ends the last of these runs (Ctrl+Shift+B).");
  }
  ImGui::Separator();
}

}  // namespace limpid
