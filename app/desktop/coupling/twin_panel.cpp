#include "app/desktop/coupling/twin_panel.h"

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

void choose(const RunNames& names, bool& edited) {
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  const Palette& colours = current_palette();
  for (const bool second : {false, true}) {
    if (second) ImGui::SameLine();
    const bool chosen = edited == second;
    ImGui::PushID(second ? "second" : "first");
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(colours.frame_active));
    if (ImGui::Button((second ? names.second : names.first).c_str(), {width, 0})) edited = second;
    if (chosen) ImGui::PopStyleColor();
    if (const int law = names.laws[second ? 1 : 0]; law >= 0) {
      underline_button(law_ink(colours, law));
    }
    tooltip("The sliders below set this one.");
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

void draw_twin(const Stage& stage, std::span<const double> first, std::span<const double> second,
               bool* edited, bool& overlaid) {
  const TraceChannels& channels = stage.channels();
  const auto count = static_cast<std::size_t>(channels.count());
  std::vector<double> a(count), b(count);
  channels.values(first, a);
  channels.values(second, b);
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
  if (ImGui::BeginTable("twin", 4)) {
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
    for (const char* widest : {"\xE2\x88\x92"
                               "8888.8",
                               "\xE2\x88\x92"
                               "8888.8 ",
                               "\xC3\x97"
                               "0.888"}) {
      ImGui::TableSetupColumn(widest, ImGuiTableColumnFlags_WidthFixed,
                              ImGui::CalcTextSize(widest).x);
    }
    for (const Line& line : kLines) {
      const auto i = static_cast<std::size_t>(line.channel);
      const double x = line.factor * a[i], y = line.factor * b[i];
      cell(line.what, true);
      cell(fixed_text(x, std::abs(x) < 10 ? 2 : 1));
      cell(fixed_text(y, std::abs(y) < 10 ? 2 : 1));
      cell(ratio(x, y, line.least));
    }
    ImGui::EndTable();
  }
  ImGui::Checkbox("both in one picture", &overlaid);
  tooltip(
      "The second run in lighter colours over the first one, instead of a picture beside it "
      "(Shift+B).");
  ImGui::Separator();
}

}  // namespace limpid
