#include "app/desktop/playback/transport.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/desktop/widgets/modal.h"
#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

std::string clock_text(double seconds) {
  const int minutes = static_cast<int>(seconds / 60);
  return fmt::format("{:02d}:{:04.1f}", minutes, seconds - 60 * minutes);
}

float button_width(const char* label) {
  return ImGui::CalcTextSize(label).x + 2 * ImGui::GetStyle().FramePadding.x;
}

// Draws a button, unless there is no room for it; a key does the same. The button is as wide as the
// label `widest` needs: a button whose label changes moves nothing beside it.
bool button(const char* label, const char* help, bool on = false, bool bad = false,
            const char* widest = nullptr) {
  if (widest == nullptr) widest = label;
  if (button_width(widest) > ImGui::GetContentRegionAvail().x) return false;
  const Palette& colours = palette(current_theme());
  if (on) {
    const Rgb back = bad ? colours.broken : colours.accent;
    ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(back));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colour_vector(back));
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(bad ? Rgb{255, 255, 255} : colours.panel));
  }
  const bool pressed = ImGui::Button(label, {button_width(widest), 0});
  if (on) ImGui::PopStyleColor(3);
  tooltip(help);
  ImGui::SameLine();
  return pressed;
}

constexpr float kTransportChoice = 74;  // width of a list at scale 1 [px]
constexpr float kTimeline = 60;         // least width of the time line at scale 1 [px]
constexpr float kProgress = 110;

// Draws a drop-down list of numbers; returns the one chosen.
double choose(const char* name, double value, std::initializer_list<double> choices,
              const char* unit) {
  const float width = kTransportChoice * current_scale();
  if (width > ImGui::GetContentRegionAvail().x) return value;
  ImGui::SetNextItemWidth(width);
  const auto text = [&](double x) { return fmt::format("{:g}{}", x, unit); };
  if (ImGui::BeginCombo(name, text(value).c_str())) {
    for (const double choice : choices) {
      if (ImGui::Selectable(text(choice).c_str(), choice == value)) value = choice;
    }
    ImGui::EndCombo();
  }
  return value;
}

// Draws marks on the time line; returns the one under the mouse.
std::optional<std::size_t> draw_marks(const PlayedSession& session) {
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const Palette& colours = current_palette();
  const float scale = current_scale(), grab = ImGui::GetStyle().GrabMinSize;
  // Marks are placed as the slider's grab: half of it stays free at either end.
  const float pad = 2 + 0.5f * grab;
  const double duration = session.player().duration();
  std::optional<std::size_t> found;
  float nearest = 5 * scale, drawn = -1;
  const float mouse = ImGui::GetIO().MousePos.x;
  for (std::size_t i = 0; i < session.marks().size(); ++i) {
    const auto part = static_cast<float>(session.time_of(session.marks()[i]) / duration);
    const float x = std::round(from.x + pad + part * (to.x - from.x - 2 * pad));
    if (std::exchange(drawn, x) == x) continue;  // a recording may have thousands
    const float r = 4 * scale;
    note_at(fmt::format("mark {}", i).c_str(), {x, 0.5f * (from.y + to.y)});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({x, from.y}, {x + std::max(1.0f, scale), to.y}, colour(colours.text, 0.6f));
    list.AddTriangleFilled({x - r, from.y}, {x + r, from.y}, {x, from.y + 1.4f * r},
                           colour(colours.text));
    if (!ImGui::IsItemHovered() || std::abs(x - mouse) > nearest) continue;
    nearest = std::abs(x - mouse);
    found = i;
  }
  return found;
}

// Draws the time line; returns the mark to be changed, if any.
std::optional<std::size_t> timeline(PlayedSession& session, float right) {
  Player& player = session.player();
  auto time = static_cast<float>(player.time());
  ImGui::SetNextItemWidth(std::max(kTimeline * current_scale(), right - ImGui::GetCursorPosX()));
  if (ImGui::SliderFloat("##timeline", &time, 0, static_cast<float>(player.duration()), "")) {
    player.pause();
    player.seek(time);
  }
  const auto mark = draw_marks(session);
  std::optional<std::size_t> changed;
  if (mark) {
    const Mark& at = session.marks()[*mark];
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) player.seek(session.time_of(at));
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) changed = mark;
    tooltip(fmt::format("{}\nA click goes to this mark. A right click renames or removes the mark.",
                        at.text)
                .c_str());
  } else {
    tooltip(
        "Drag to go to any moment. The left and right arrow keys go one tick back or forward, with "
        "Shift 0.1 s. T sets a mark.");
  }
  ImGui::SameLine();
  return changed;
}

void rerun_controls(Playback& playback, const Act& act) {
  if (!playback.rerunning()) {
    if (button("Re-run",
               "Runs a new simulation with the recorded hand motion and the present settings, and "
               "shows it beside the recording (E).")) {
      act("session.rerun");
    }
    return;
  }
  progress_bar(playback.rerun_part(), kProgress * current_scale(), "re-running");
  ImGui::SameLine();
  if (button("Cancel", "Stop the re-run")) playback.cancel_rerun();
}

std::optional<std::size_t> playback_controls(Playback& playback, const Act& act) {
  Player& player = playback.shown()->player();
  const float scale = current_scale();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const std::string clock = clock_text(player.time()) + " / " + clock_text(player.duration());
  // Controls without room are left out, the least important first.
  float room = ImGui::GetContentRegionAvail().x - button_width("Pause") - kTimeline * scale -
               button_width("Back to live") - 3 * gap;
  const auto fits = [&](float width) {
    const bool enough = width + gap <= room;
    if (enough) room -= width + gap;
    return enough;
  };
  const bool with_clock = fits(ImGui::CalcTextSize(clock.c_str()).x);
  const bool with_rerun =
      fits(playback.rerunning() ? kProgress * scale + gap + button_width("Cancel")
                                : button_width("Re-run"));
  const bool with_speed = fits(kTransportChoice * scale);
  const bool with_steps = fits(button_width("|<") + 2 * button_width("<") + 2 * gap);
  const bool with_loop = fits(button_width("Loop"));

  const char* const play = player.playing() ? "Pause" : "Play";
  if (button(play, "P plays and pauses.", false, false, "Pause")) act("session.play");
  if (with_steps) {
    if (button("|<", "To the beginning (Home)")) player.seek(0);
    if (button("<", "One tick back (left arrow)")) player.step(-1);
    if (button(">", "One tick forward (right arrow)")) player.step(1);
  }
  if (with_loop && button("Loop", "At the end, playback begins again (L)", player.loop)) {
    player.loop = !player.loop;
  }
  if (with_speed) {
    player.speed = choose("##speed", player.speed, {0.1, 0.2, 0.5, 1, 2, 5, 10}, "x");
    tooltip("Speed of playback, 0.1 to 10");
    ImGui::SameLine();
  }
  if (with_rerun) rerun_controls(playback, act);
  const float after = button_width("Back to live") + gap +
                      (with_clock ? ImGui::CalcTextSize(clock.c_str()).x + gap : 0);
  const auto changed = timeline(*playback.shown(), ImGui::GetWindowContentRegionMax().x - after);
  if (with_clock) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock.c_str());
    ImGui::SameLine();
  }
  if (button("Back to live", "Closes the recording. You move the device again (Backspace).")) {
    act("session.back_to_live");
  }
  return changed;
}

void recording_controls(const LiveStage& live, double tick, const Act& act) {
  const LiveLoop& loop = live.loop();
  const bool recording = loop.recording();
  if (button(recording ? "Stop" : "Record",
             "R starts or stops a recording of every tick. While an object is selected, R turns "
             "the object, and Ctrl+R records.",
             recording, true, "Record")) {
    act("session.record");
  }
  if (recording) {
    const double seconds = static_cast<double>(loop.recorder()->rows()) * tick;
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(clock_text(seconds).c_str());
    tooltip(loop.recorder()->out().c_str());
    ImGui::SameLine();
  } else if (button("Play", "Plays the last recording, or opens a recording (P).")) {
    act("session.play");
  }
  const std::string& trouble = live.last_recording().trouble;
  if (recording || trouble.empty()) return;
  ImGui::AlignTextToFramePadding();
  ImGui::TextColored(colour_vector(current_palette().broken), "the recording ended");
  tooltip(trouble.c_str());
  ImGui::SameLine();
}

// Draws controls of the virtual arm's time: its speed, or single ticks.
void time_controls(LiveStage& live, const Act& act) {
  if (!live.why_time_is_fixed().empty()) return;
  const bool paused = live.paused();
  if (button("Pause", "Pauses the simulation until you press this button again (K).", paused)) {
    act("loop.pause");
  }
  if (paused) {
    if (button(">", "One tick forward (right arrow), or ten ticks with Shift")) act("loop.step");
    return;
  }
  int& slow = live.controls().slow;
  slow = static_cast<int>(std::lround(1 / choose("##slow", 1.0 / slow, {1, 0.1, 0.01}, "x")));
  tooltip(
      "Speed of the simulation. Slow motion does not slow you: the mouse still moves the hand's "
      "target at full speed.");
  ImGui::SameLine();
}

void live_controls(LiveStage& live, double tick, double& plot_length, const Act& act) {
  recording_controls(live, tick, act);
  if (button("Open...", "Choose a recorded session (Ctrl+O).")) act("session.open");
  if (button("A/B", "Changes to the next coupling law, without a jump (C).")) {
    act("coupling.next");
  }
  PlotGroup& group = live.stage().group;
  if (button(group.following() ? "Freeze plots" : "Follow",
             "Freezes the plots, or lets them follow the running time again (X).",
             !group.following())) {
    act("plots.freeze");
  }
  const double length = choose("##length", plot_length, {1, 2, 5, 10, 20, 30, 60}, " s");
  if (length != plot_length) {
    plot_length = length;
    group.set_fitted_length(length);
    group.fit();
  }
  tooltip("How much time the plots show, 1 to 60 s");
  ImGui::SameLine();
  time_controls(live, act);
  if (button("Start over",
             "Puts device and proxy at rest in the middle. The force of a real device is switched "
             "off (Backspace).")) {
    act("device.start_over");
  }
}

}  // namespace

std::optional<std::size_t> draw_transport(Playback& playback, LiveStage& live, double tick,
                                          double& plot_length, const Act& act, ScreenRect rect) {
  begin_panel("transport", rect);
  std::optional<std::size_t> mark;
  if (playback.loading()) {
    ImGui::AlignTextToFramePadding();
    ImGui::Text("%s ...", playback.what().c_str());
    if (playback.loading_part() > 0) {
      ImGui::SameLine();
      progress_bar(playback.loading_part(), kProgress * current_scale());
      ImGui::SameLine();
      if (button("Cancel", "Cancels this work. The window keeps its present content."))
        playback.cancel_loading();
    }
  } else if (playback.on()) {
    mark = playback_controls(playback, act);
  } else {
    live_controls(live, tick, plot_length, act);
  }
  ImGui::End();
  return mark;
}

}  // namespace limpid
