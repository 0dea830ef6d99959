#include "app/desktop/shell/status_line.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <vector>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

constexpr float kLongestName = 14;  // of the recording that is played [em]

struct StatusPart {
  std::string text;
  Rgb ink;
  std::string help;
  int law = -1;  // law whose colour stands before the text; -1: none
};

StatusPart force_part(const Snapshot& now) {
  const Palette& colours = current_palette();
  const std::string why = explain(now.force_state);
  switch (now.arming) {
    case Arming::on:
      return {"force on [Esc]", colours.text, "Esc or Space switches the force off at once"};
    case Arming::fading: return {"force fades [Esc]", colours.text, "Force: " + why};
    case Arming::waiting:
      return {"force waits [Esc]", colours.text,
              "The force fades in when the hand holds the device: " + why};
    case Arming::tripped:
      return {"force off [F]", colours.broken,
              "Force is off: " + why + ". Key F switches the force on again."};
    case Arming::off: break;
  }
  return {"force off [F]", colours.text, "Key F switches the force on"};
}

// Returns rate, missed ticks and coupling, the most important last.
std::vector<StatusPart> status_parts(const LiveLoop& loop, const StatusLaw& law,
                                     const StatusGoing& going) {
  const Palette& colours = current_palette();
  const LoopStatus status = loop.status();
  const bool stopped = !status.running;
  std::vector<StatusPart> parts;
  const auto& [played, pace, led] = going;
  if (!played.empty()) {
    const float room = kLongestName * ImGui::GetFontSize();
    parts.push_back({"playing " + shortened(played, room, ImGui::GetFont()), colours.text, played});
  }
  // The recording's button is in the bar below only while the loop is shown.
  if (!played.empty() && loop.recording()) {
    parts.push_back({"recording [R]", colours.broken,
                     "The live loop is still recorded during playback. R ends the recording."});
  }
  if (led) {
    parts.push_back(
        {"led by a program", colours.accent,
         "A script or another program has set law, settings or scene. Your own settings "
         "come back when that program ends."});
  }
  if (!pace.empty()) {
    parts.push_back({pace, colours.accent,
                     "Pauses or slows only the simulation; the control loop keeps running."});
  }
  parts.push_back({stopped ? "loop stopped" : fmt::format("{:.0f} Hz", status.rate),
                   stopped ? colours.broken : colours.muted, status.failure});
  const double missed = static_cast<double>(status.missed) /
                        static_cast<double>(std::max<std::int64_t>(status.ticks, 1));
  parts.push_back(
      {missed < 1e-3 ? "on time" : fmt::format("{:.1f} % of ticks missed", 100 * missed),
       missed > 0.01 ? colours.broken : colours.muted,
       fmt::format("{} ticks were missed, because they began after the next tick was due.\n{} "
                   "ticks began more than 0.2 ms late. {} ticks were skipped {}.",
                   status.missed, status.late, status.slipped,
                   loop.device_in_place() ? "immediately" : "after a long stop of the loop")});
  std::string name = info(law.kind).label;
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
  if (info(law.kind).takes_eta) name += fmt::format(" \xCE\xB7 {:.2f}", law.eta);
  parts.push_back({name, colours.text, "C switches", static_cast<int>(law.kind)});
  return parts;
}

constexpr float kBetween = 1.4f, kDot = 0.8f;  // [em]

float status_width(const StatusPart& part) {
  return ImGui::CalcTextSize(part.text.c_str()).x + kBetween * ImGui::GetFontSize() +
         (part.law < 0 ? 0 : kDot * ImGui::GetFontSize());
}

}  // namespace

float least_status_width(const LiveLoop& loop) { return status_width(force_part(loop.snapshot())); }

void draw_status(const LiveLoop& loop, const StatusLaw& law, const StatusGoing& going) {
  std::vector<StatusPart> parts = status_parts(loop, law, going);
  const Snapshot now = loop.snapshot();
  if (going.played.empty() || (loop.device_in_place() && now.armed())) {
    parts.push_back(force_part(now));
  } else {
    parts.push_back(
        {"space plays [Esc: live]", current_palette().muted,
         "Space plays and pauses. A click in a plot goes to that time. Esc goes back to live."});
  }
  const float room = ImGui::GetWindowWidth() - ImGui::GetCursorPosX();
  float width = 0;
  auto first = parts.end();
  while (first != parts.begin()) {
    const float more = status_width(*std::prev(first));
    if (first != parts.end() && width + more > room) break;
    width += more;
    --first;
  }
  ImGui::SameLine(ImGui::GetWindowWidth() - width);
  const float em = ImGui::GetFontSize();
  for (; first != parts.end(); ++first) {
    if (first->law >= 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + kDot * em);
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(first->ink));
    ImGui::TextUnformatted(first->text.c_str());
    ImGui::PopStyleColor();
    if (first->law >= 0) {
      const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
      const float side = 0.5f * em, left = from.x - kDot * em, top = 0.5f * (from.y + to.y - side);
      ImGui::GetWindowDrawList()->AddRectFilled({left, top}, {left + side, top + side},
                                                colour(law_ink(current_palette(), first->law)));
    }
    if (!first->help.empty()) tooltip(first->help.c_str());
    ImGui::SameLine(0, kBetween * em);
  }
}

}  // namespace limpid
