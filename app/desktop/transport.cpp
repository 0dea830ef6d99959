#include <fmt/format.h>

#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

std::string clock_text(double seconds) {
  const int minutes = static_cast<int>(seconds / 60);
  return fmt::format("{:02d}:{:04.1f}", minutes, seconds - 60 * minutes);
}

bool button(const char* label, const char* help, bool on = false, bool bad = false) {
  const Palette& colours = palette(current_theme());
  if (on) {
    const Rgb back = bad ? colours.broken : colours.accent;
    ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(back));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, colour_vector(back));
    ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(bad ? Rgb{255, 255, 255} : colours.panel));
  }
  const bool pressed = ImGui::Button(label);
  if (on) ImGui::PopStyleColor(3);
  tooltip(help);
  ImGui::SameLine();
  return pressed;
}

// A drop-down list of numbers; returns the one chosen.
double choose(const char* name, double value, std::initializer_list<double> choices,
              const char* unit) {
  ImGui::SetNextItemWidth(74 * current_scale());
  const auto text = [&](double x) { return fmt::format("{:g}{}", x, unit); };
  if (ImGui::BeginCombo(name, text(value).c_str())) {
    for (const double choice : choices) {
      if (ImGui::Selectable(text(choice).c_str(), choice == value)) value = choice;
    }
    ImGui::EndCombo();
  }
  return value;
}

void timeline(Workbench& bench, float right) {
  Player& player = bench.playback->player;
  auto time = static_cast<float>(player.time());
  ImGui::SetNextItemWidth(std::max(60.0f, right - ImGui::GetCursorPosX()));
  if (ImGui::SliderFloat("##timeline", &time, 0, static_cast<float>(player.duration()), "")) {
    player.pause();
    player.seek(time);
  }
  tooltip("Drag to any moment; left and right arrow step by a tick, with Shift by 0.1 s.");
  ImGui::SameLine();
}

void playback_controls(Workbench& bench) {
  Player& player = bench.playback->player;
  if (button(player.playing() ? "Pause" : "Play", "P plays and pauses.")) bench.toggle_playing();
  if (button("|<", "To the beginning (Home)")) player.seek(0);
  if (button("<", "One tick back (left arrow)")) player.step(-1);
  if (button(">", "One tick on (right arrow)")) player.step(1);
  if (button("Loop", "Begin again at the end (L)", player.loop)) player.loop = !player.loop;
  const float scale = current_scale();
  player.speed = choose("##speed", player.speed, {0.1, 0.2, 0.5, 1, 2, 5, 10}, "x");
  tooltip("Speed of playback, 0.1 to 10");
  ImGui::SameLine();
  if (bench.rerunning.busy()) {
    ImGui::ProgressBar(static_cast<float>(bench.rerunning.part()), {110 * scale, 0}, "re-running");
    ImGui::SameLine();
    if (button("Cancel", "Stop the re-run")) bench.rerunning.cancel();
  } else if (button("Re-run",
                    "Let the recorded hand drive a new simulation under the present "
                    "settings and show it beside the recording (E).")) {
    bench.start_rerun();
  }
  const std::string clock = clock_text(player.time()) + " / " + clock_text(player.duration());
  const float right = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize("Back to live").x -
                      ImGui::CalcTextSize(clock.c_str()).x - 4 * ImGui::GetStyle().ItemSpacing.x;
  timeline(bench, right);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(clock.c_str());
  ImGui::SameLine();
  if (button("Back to live", "Leave the recording; the device is yours again (Backspace).")) {
    bench.close_playback();
  }
}

void live_controls(Workbench& bench) {
  const bool recording = bench.live.recording();
  if (button(recording ? "Stop" : "Record", "R starts and stops recording every tick.", recording,
             true)) {
    bench.toggle_recording();
  }
  if (recording) {
    const double seconds =
        static_cast<double>(bench.live.recorder()->rows()) * bench.parameters.tick;
    ImGui::AlignTextToFramePadding();
    ImGui::Text("%s  %s", clock_text(seconds).c_str(),
                bench.live.recorder()->out().filename().c_str());
    ImGui::SameLine();
  } else if (button("Play", "Plays the last recording, or opens one (P).")) {
    bench.toggle_playing();
  }
  if (button("Open...", "Choose a recorded session (Ctrl+O).")) bench.dialog = Dialog::open_session;
  if (button("A/B", "Switch between standard and proposed coupling without a jump (C).")) {
    bench.toggle_coupling();
  }
  PlotGroup& group = bench.stage->group;
  if (button(group.following() ? "Freeze plots" : "Follow", "Holds the plots or lets them run (X).",
             !group.following())) {
    group.set_following(!group.following());
  }
  const double length =
      choose("##length", bench.settings.plot_length, {1, 2, 5, 10, 20, 30, 60}, " s");
  if (length != bench.settings.plot_length) {
    bench.settings.plot_length = length;
    group.set_fitted_length(length);
    group.fit();
  }
  tooltip("How much time the plots show, 1 to 60 s");
  ImGui::SameLine();
  if (button("Start over", "Device and proxy at rest in the middle, force on (Backspace).")) {
    bench.start_over();
  }
}

}  // namespace

void draw_transport(Workbench& bench, const ScreenRect& rect) {
  begin_panel("transport", rect);
  if (bench.loading.busy()) {
    ImGui::AlignTextToFramePadding();
    ImGui::Text("%s ...", bench.loading.what().c_str());
  } else if (bench.playing_back()) {
    playback_controls(bench);
  } else {
    live_controls(bench);
  }
  ImGui::End();
}

}  // namespace limpid
