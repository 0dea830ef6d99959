#include "app/desktop/plots/plot_chooser.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "app/style/words.h"

namespace limpid {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool chosen(const PlotChoice& choice, const std::string& key) {
  return std::ranges::find(choice.channels, key) != choice.channels.end();
}

void toggle(PlotChoice& choice, const std::string& key) {
  if (std::erase(choice.channels, key) == 0) choice.channels.push_back(key);
}

void muted(const char* text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(current_palette().muted));
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
}

}  // namespace

bool meant_by(const ChannelInfo& channel, const std::string& words) {
  const std::string all = lower(channel.group + " " + channel.name + " " + channel.label + " " +
                                channel.unit + " " + channel.key);
  // Synonyms that people use.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kSame{
      {{"human", "hand"},
       {"depth", "gap"},
       {"penetration", "gap"},
       {"drift", "gap"},
       {"error", "gap"}}};
  const auto has = [&](std::string_view word) { return all.find(word) != std::string::npos; };
  std::istringstream in(lower(words));
  for (std::string word; in >> word;) {
    const bool meant = has(word) || std::ranges::any_of(kSame, [&](const auto& same) {
                         return same.first.starts_with(word) && word.size() > 2 && has(same.second);
                       });
    if (!meant) return false;
  }
  return true;
}

bool PlotChooser::draw(bool& open, PlotChoice& choice, const TraceChannels& channels,
                       ScreenRect anchor) {
  if (!open) return was_open_ = false;
  const bool appears = !was_open_;
  was_open_ = true;
  const float em = ImGui::GetFontSize();
  const float width = std::min(34 * em, anchor.width());
  const float height = std::min(30 * em, anchor.height());
  ImGui::SetNextWindowPos({anchor.min.x + 0.5f * anchor.width(), anchor.max.y - 0.2f * em},
                          ImGuiCond_Always, {0.5f, 1});
  ImGui::SetNextWindowSize({width, height});
  if (appears) {
    ImGui::SetNextWindowFocus();
    filter_.clear();
  }
  begin_dialog("What the plot shows", open, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
  draw_kinds(choice, channels);
  if (appears) ImGui::SetKeyboardFocusHere();
  draw_filter(choice, channels);
  ImGui::BeginChild("channels", {0, -ImGui::GetFrameHeightWithSpacing()}, true);
  draw_list(choice, channels);
  ImGui::EndChild();
  const float button = 7 * em;
  close_button("Done (Esc)", open);
  if (done_) open = false;
  ImGui::SameLine();
  if (ImGui::Button("None", {button, 0})) choice.channels.clear();
  tooltip("Takes all channels out of the plot.");
  ImGui::SameLine();
  const bool remove = ImGui::Button("Remove plot", {1.4f * button, 0});
  if (remove) open = false;
  ImGui::End();
  return remove;
}

// Draws the choice of the horizontal axis, and of the name.
void PlotChooser::draw_kinds(PlotChoice& choice, const TraceChannels& channels) {
  struct Kind {
    PlotKind kind;
    const char *label, *help;
  };
  constexpr std::array kKinds{
      Kind{PlotKind::time, "over time", "The channels over time."},
      Kind{PlotKind::cross, "against a channel",
           "The channels against another one, which \"along x\" in the list below chooses."},
      Kind{PlotKind::spectrum, "spectrum",
           "Amplitude over frequency of the stretch of time that the plots show."}};
  ImGui::PushItemWidth(-1);
  const PlotChoice unnamed{
      .kind = choice.kind, .across = choice.across, .channels = choice.channels};
  const std::string hint = "name: " + title_of(unnamed, channels);
  ImGui::InputTextWithHint("##title", hint.c_str(), &choice.title);
  ImGui::PopItemWidth();
  for (const Kind& kind : kKinds) {
    if (&kind != kKinds.data()) flow(kind.label);
    if (ImGui::RadioButton(kind.label, choice.kind == kind.kind)) choice.kind = kind.kind;
    tooltip(kind.help);
  }
  if (choice.kind == PlotKind::cross && choice.across.empty()) {
    choice.across = "proxy/contact_torque_norm";
  }
}

// Draws the filter. Enter takes the first channel listed, and clears the words; without words it
// closes the chooser.
void PlotChooser::draw_filter(PlotChoice& choice, const TraceChannels& channels) {
  ImGui::PushItemWidth(-1);
  const bool entered = ImGui::InputTextWithHint(
      "##filter", "filter, as torque 2; Enter takes the first, Enter again is done", &filter_,
      ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::PopItemWidth();
  done_ = entered && filter_.empty();
  if (!entered || done_) return;
  ImGui::SetKeyboardFocusHere(-1);
  const auto infos = channels.infos();
  const auto first =
      std::ranges::find_if(infos, [&](const ChannelInfo& c) { return meant_by(c, filter_); });
  if (first != infos.end()) toggle(choice, first->key);
  filter_.clear();
}

void PlotChooser::draw_list(PlotChoice& choice, const TraceChannels& channels) const {
  std::vector<std::string> groups;
  for (const ChannelInfo& channel : channels.infos()) {
    if (!meant_by(channel, filter_)) continue;
    if (std::ranges::find(groups, channel.group) == groups.end()) groups.push_back(channel.group);
  }
  if (groups.empty()) muted("No channel has these words.");
  for (const std::string& group : groups) {
    ImGui::PushFont(font(Face::semibold));
    ImGui::TextUnformatted(group.c_str());
    ImGui::PopFont();
    for (const ChannelInfo& channel : channels.infos()) {
      if (channel.group == group && meant_by(channel, filter_)) draw_channel(choice, channel);
    }
    ImGui::Spacing();
  }
}

void PlotChooser::draw_channel(PlotChoice& choice, const ChannelInfo& channel) const {
  ImGui::PushID(channel.key.c_str());
  bool on = chosen(choice, channel.key);
  if (ImGui::Checkbox(channel.name.c_str(), &on)) toggle(choice, channel.key);
  tooltip((channel.help + "\n" + channel.key).c_str());
  const float em = ImGui::GetFontSize();
  const float right = ImGui::GetWindowContentRegionMax().x;
  const bool cross = choice.kind == PlotKind::cross;
  ImGui::SameLine(right - (cross ? 11 : 5) * em);
  muted(channel.unit == "-" ? "" : channel.unit.c_str());
  if (cross) {
    ImGui::SameLine(right - 6 * em);
    if (ImGui::RadioButton("along x", choice.across == channel.key)) choice.across = channel.key;
  }
  ImGui::PopID();
}

}  // namespace limpid
