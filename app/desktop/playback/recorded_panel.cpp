#include "app/desktop/playback/recorded_panel.h"

#include <imgui.h>

#include <algorithm>
#include <sstream>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/sliders.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

std::string value_of(const ParameterInfo& info, const Parameters& p) {
  if (info.is_number()) return with_unit(info, parameter_number(p, info));
  std::string text = parameter_text(p, info);
  std::erase(text, '"');
  return text == "true" ? "on" : text == "false" ? "off" : text;
}

// Returns whether a setting has a line: the law, unusual values and, with `everything`, the grip
// and the law's sliders do, but for a flag.
bool told(const ParameterInfo& info, const Parameters& p, bool everything) {
  const std::string key = info.key;
  if (key == "coupling.kind") return true;
  if (parameter_text(p, info) != parameter_text(Parameters{}, info)) return true;
  const bool of_grip = key == "hand.stiffness" || key == "hand.damping";
  return everything && info.kind != FieldInfo::Kind::flag &&
         (of_grip || limpid::info(p.kind).has(key));
}

void cell(const std::string& text, Rgb ink) {
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(ink));
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

void row(const RecordedSetting& setting) {
  const Palette& colours = current_palette();
  ImGui::TableNextRow();
  cell(setting.name, colours.muted);
  if (!setting.help.empty()) tooltip(setting.help.c_str());
  for (const std::string& value : setting.values) cell(value, colours.text);
}

// Returns the width of the widest word of all values.
float widest_word(const std::vector<RecordedSetting>& settings) {
  float most = 0;
  for (const RecordedSetting& setting : settings) {
    for (const std::string& value : setting.values) {
      std::istringstream words(value);
      for (std::string word; words >> word;) {
        most = std::max(most, ImGui::CalcTextSize(word.c_str()).x);
      }
    }
  }
  return most;
}

}  // namespace

std::vector<RecordedSetting> recorded_settings(std::span<const Parameters> lanes, bool everything) {
  std::vector<RecordedSetting> all;
  for (const ParameterInfo& each : parameter_table()) {
    const auto has_line = [&](const Parameters& p) { return told(each, p, everything); };
    if (std::ranges::none_of(lanes, has_line)) continue;
    RecordedSetting& setting = all.emplace_back(RecordedSetting{each.caption, {}, each.meaning});
    for (const Parameters& p : lanes) setting.values.push_back(value_of(each, p));
  }
  return all;
}

void draw_recorded(PlayedSession& session, bool everything) {
  std::vector<Parameters> lanes = session.lane_settings();
  if (session.has_rerun()) lanes.resize(1);
  const int columns = 1 + static_cast<int>(lanes.size());
  const std::vector<RecordedSetting> settings = recorded_settings(lanes, everything);
  constexpr float kOfName = 1.4f;  // width of the first column, in those of a value
  const float share =
      ImGui::GetContentRegionAvail().x / (kOfName + static_cast<float>(columns - 1));
  const float padding = 2 * ImGui::GetStyle().CellPadding.x;
  const float width = std::max(share - padding, widest_word(settings) + 1);
  if (!ImGui::BeginTable("recorded", columns, ImGuiTableFlags_BordersInnerH)) return;
  ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
  for (int i = 1; i < columns; ++i) {
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthFixed, width);
  }
  for (const std::vector<Fact>& facts : {session.facts(), session.verdict()}) {
    for (const Fact& fact : facts) {
      row({fact.name, std::vector<std::string>(lanes.size(), fact.value)});
    }
  }
  for (const RecordedSetting& setting : settings) row(setting);
  ImGui::EndTable();
}

}  // namespace limpid
