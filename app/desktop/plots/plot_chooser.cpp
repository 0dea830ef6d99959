#include "app/desktop/plots/plot_chooser.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
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

// Groups of channels, what hands and eyes know first.
constexpr std::array<std::string_view, 9> kGroupOrder{
    "Contacts", "Coordination error", "Energy", "Hand", "Device", "Proxy",
    "Objects",  "Coupling",           "Timing"};
// Keys of what people look at most.
constexpr std::array<std::string_view, 6> kMostLookedAt{
    "contact/total_force_norm", "coordination/gap", "coordination/error",
    "energy/controller_total",  "hand/torque_norm", "device/tip_speed"};

// Returns the channel's place in the list without words.
int place_of(const ChannelInfo& channel) {
  const auto most = std::ranges::find(kMostLookedAt, channel.key) - kMostLookedAt.begin();
  const auto group = std::ranges::find(kGroupOrder, channel.group) - kGroupOrder.begin();
  const auto size = static_cast<std::ptrdiff_t>(kMostLookedAt.size());
  return static_cast<int>(most < size ? most : size + group);
}

// Returns how far a word is from a channel: 0 where a word of its name begins so, 1 elsewhere in
// name and label, 2 in group, unit and key, 3 by another word for the same; nothing without it.
std::optional<int> apart_from_word(const ChannelInfo& channel, std::string_view word) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kSame{
      {{"human", "hand"},
       {"depth", "gap"},
       {"penetration", "gap"},
       {"drift", "gap"},
       {"error", "gap"},
       {"work", "energy"},
       {"power", "energy"},
       {"effort", "torque"}}};
  const auto has = [](const std::string& text, std::string_view part) {
    return small_letters(text).find(part) != std::string::npos;
  };
  const auto anywhere = [&](std::string_view part) {
    return has(channel.group + " " + channel.unit + " " + channel.key, part);
  };
  const bool begins =
      small_letters(channel.name).starts_with(word) || has(channel.name, " " + std::string(word));
  if (begins) return 0;
  if (has(channel.name + " " + channel.label, word)) return 1;
  if (anywhere(word)) return 2;
  const bool meant = std::ranges::any_of(kSame, [&](const auto& same) {
    return same.first.starts_with(word) && word.size() > 2 &&
           (anywhere(same.second) || has(channel.name + " " + channel.label, same.second));
  });
  return meant ? std::optional(3) : std::nullopt;
}

// Returns the sum over all words; nothing if one is not in it.
std::optional<int> apart_from(const ChannelInfo& channel, const std::string& words) {
  int apart = 0;
  std::istringstream in(small_letters(words));
  for (std::string word; in >> word;) {
    const std::optional<int> of_word = apart_from_word(channel, word);
    if (!of_word) return std::nullopt;
    apart += *of_word;
  }
  return apart;
}

}  // namespace

std::vector<const ChannelInfo*> meant_by(const std::string& words, const TraceChannels& channels) {
  struct Found {
    const ChannelInfo* channel;
    int apart, place;
  };
  std::vector<Found> all;
  for (const ChannelInfo& channel : channels.infos()) {
    if (const auto apart = apart_from(channel, words)) {
      all.push_back({&channel, *apart, place_of(channel)});
    }
  }
  std::ranges::stable_sort(all, {}, [](const Found& f) { return std::pair(f.apart, f.place); });
  std::vector<const ChannelInfo*> found(all.size());
  std::ranges::transform(all, found.begin(), &Found::channel);
  return found;
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
  tooltip("Removes all channels from the plot.");
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
      Kind{PlotKind::time, "over time", "The channels against time."},
      Kind{PlotKind::cross, "against a channel",
           "The channels against another channel. Choose this channel with \"along x\" in the list "
           "below."},
      Kind{PlotKind::spectrum, "spectrum",
           "Amplitude against frequency, for the time that the plots show."}};
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
      "##filter", "filter, e.g. torque 2; Enter: first channel, again: close", &filter_,
      ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::PopItemWidth();
  done_ = entered && filter_.empty();
  if (!entered || done_) return;
  ImGui::SetKeyboardFocusHere(-1);
  const auto found = meant_by(filter_, channels);
  if (!found.empty()) toggle(choice, found.front()->key);
  filter_.clear();
}

void PlotChooser::draw_list(PlotChoice& choice, const TraceChannels& channels) const {
  const std::vector<const ChannelInfo*> found = meant_by(filter_, channels);
  if (found.empty()) muted("No channel matches the words of the filter.");
  std::string heading;
  for (const ChannelInfo* channel : found) {
    const bool looked_at =
        filter_.empty() && std::ranges::find(kMostLookedAt, channel->key) != kMostLookedAt.end();
    const std::string group = looked_at ? "Most used channels" : channel->group;
    if (group != heading) {
      if (!heading.empty()) ImGui::Spacing();
      ImGui::PushFont(font(Face::semibold));
      ImGui::TextUnformatted(group.c_str());
      ImGui::PopFont();
      heading = group;
    }
    draw_channel(choice, *channel,
                 looked_at ? channel->group + ": " + channel->name : channel->name);
  }
}

void PlotChooser::draw_channel(PlotChoice& choice, const ChannelInfo& channel,
                               const std::string& name) const {
  ImGui::PushID(channel.key.c_str());
  bool on = chosen(choice, channel.key);
  if (ImGui::Checkbox(name.c_str(), &on)) toggle(choice, channel.key);
  note_place(channel.key.c_str());
  if (ImGui::BeginDragDropSource()) {
    ImGui::SetDragDropPayload(kDraggedChannel, channel.key.data(), channel.key.size());
    ImGui::TextUnformatted((channel.label + ": drop it into another plot").c_str());
    ImGui::EndDragDropSource();
  }
  tooltip((channel.help + "\n" + channel.key + "\nCan be dragged into any plot.").c_str());
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
