#include <fmt/format.h>

#include <array>

#include "app/desktop/device_panel.h"
#include "app/desktop/panels.h"
#include "app/style/palette.h"
#include "app/style/parameter_slider.h"
#include "app/style/theme.h"

namespace limpid {
namespace {

void sliders(Workbench& bench, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const ParameterInfo& info = *find_parameter(key);
    if (!info.live) continue;
    // What is left to the arm shows the arm's value, and stays the arm's until it is moved.
    Parameters shown = bench.parameters;
    const ArmDescription& arm = bench.shown().arm();
    if (std::isnan(shown.friction)) shown.friction = arm.joints.front().friction;
    if (std::isnan(shown.damping)) shown.damping = arm.joints.front().damping;
    if (std::isnan(shown.torque_limit)) shown.torque_limit = arm.joints.front().effort;
    const double paper = parameter_number(Parameters{}, info);
    if (parameter_slider(info, shown, paper)) {
      set_parameter_number(bench.parameters, info, parameter_number(shown, info));
    }
  }
}

// Shares of ticks over wake-up latency, on a logarithmic axis from 1 us to 100 ms.
void draw_histogram(const LatencyHistogram& histogram) {
  const Palette& colours = palette(current_theme());
  const float height = 32 * current_scale();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled(at, {at.x + width, at.y + height}, colour(colours.frame, 0.5f), 3);
  constexpr int kColumns = 50;
  constexpr int kPerColumn = LatencyHistogram::kBins / kColumns;
  std::array<double, kColumns> columns{};
  double most = 1;
  for (int i = 0; i < LatencyHistogram::kBins; ++i) {
    double& column = columns[static_cast<std::size_t>(i / kPerColumn)];
    column += static_cast<double>(histogram.count_in(i));
    most = std::max(most, column);
  }
  const float step = width / kColumns;
  for (int i = 0; i < kColumns; ++i) {
    const double share = columns[static_cast<std::size_t>(i)];
    if (share == 0) continue;
    const auto tall = static_cast<float>(std::log1p(share) / std::log1p(most)) * (height - 4);
    const float x = at.x + step * static_cast<float>(i);
    const bool late = LatencyHistogram::upper_edge(i * kPerColumn) > 1e-3;
    draw->AddRectFilled({x, at.y + height - tall}, {x + step - 1, at.y + height},
                        colour(late ? colours.broken : colours.muted));
  }
  ImGui::Dummy({width, height});
  tooltip(
      "Wake-up latency of the haptic thread, 1 us to 100 ms, both axes logarithmic; red: over "
      "one tick.");
}

void draw_timing(Workbench& bench, double frame_time) {
  const LoopStatus status = bench.live.status();
  read_out("haptic rate", fmt::format("{:.1f} Hz", status.rate),
           status.running ? std::string() : "The loop has stopped: " + status.failure);
  const LatencyHistogram& wake = bench.live.thread().wake_latency();
  read_out("wake-up p50 / p99",
           fmt::format("{:.0f} / {:.0f} us", 1e6 * wake.quantile(0.5), 1e6 * wake.quantile(0.99)),
           {}, "How long after its deadline a tick begins");
  draw_histogram(wake);
  const LatencyHistogram& compute = bench.live.thread().compute_time();
  read_out("tick takes p50 / p99", fmt::format("{:.0f} / {:.0f} us", 1e6 * compute.quantile(0.5),
                                               1e6 * compute.quantile(0.99)));
  const auto of_ticks = [&](std::int64_t count) {
    return count == 0
               ? std::string("0")
               : fmt::format("{} ({:.2g} %)", count,
                             100.0 * static_cast<double>(count) /
                                 static_cast<double>(std::max<std::int64_t>(status.ticks, 1)));
  };
  read_out("late over 0.2 ms", of_ticks(status.late), {},
           "Ticks that began more than 0.2 ms after their deadline");
  read_out("missed", of_ticks(status.missed),
           status.missed > status.ticks / 100
               ? "More than one tick in a hundred began over a tick late. Close other programs, or "
                 "grant real-time priority (rtkit, or an rtprio limit)."
               : "",
           "Ticks that began after the next one was due; they are caught up");
  read_out("slipped", of_ticks(status.slipped),
           status.slipped > 0 ? "After a stall of over 20 ticks the loop went on later instead of "
                                "catching up; simulated time lost that much against the clock."
                              : "",
           "Ticks given up after long stalls");
  read_out("scheduling",
           status.realtime.realtime() ? fmt::format("real-time {}", status.realtime.priority)
                                      : "ordinary",
           {}, status.realtime.explanation.c_str());
  const std::uint64_t dropped =
      bench.live.trace_dropped() + (bench.live.recording() ? bench.live.recorder()->dropped() : 0);
  if (dropped > 0) {
    read_out("ticks dropped", std::to_string(dropped),
             "Ticks that found no room on their way to the plots or the recording.");
  }
  const Settings& s = bench.settings;
  read_out("picture quality",
           s.picture_quality == "automatic"
               ? fmt::format("automatic, {} of {}", 1 + Quality::kLowest - bench.quality_level(),
                             1 + Quality::kLowest)
               : s.picture_quality,
           {}, "View > Picture quality. Automatic: as good as this computer draws smoothly");
  read_out("frame", fmt::format("{:.1f} ms", 1e3 * frame_time), {},
           "Work for one picture; the loop does not wait for it");
}

bool section(const char* name, bool open) {
  ImGui::PushFont(font(Face::semibold));
  const bool shown = ImGui::CollapsingHeader(
      name, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  ImGui::PopFont();
  return shown;
}

}  // namespace

void SidePanel::draw(Workbench& bench, const ScreenRect& rect, double frame_time) {
  begin_panel("side", rect);
  if (section("Scene", true)) scene_.draw(bench);
  if (section("Hand", true)) {
    sliders(bench, {"hand.stiffness", "hand.damping"});
    ImGui::Checkbox("hold where released", &bench.settings.hold_on_release);
    tooltip("When the mouse button is released the hand stays where it is instead of letting go.");
  }
  if (section("Device", !bench.devices.hub.in_use().empty())) {
    draw_device_panel(bench);
    sliders(bench, {"device.torque_limit", "observer.anti_windup", "device.damping",
                    "device.friction", "device.encoder_step", "observer.velocity",
                    "model.inertia_error", "proxy.inertia_ratio"});
  }
  if (section("Analysis", false)) analysis_.draw(bench);
  if (section("Timing", true)) draw_timing(bench, frame_time);
  ImGui::End();
}

}  // namespace limpid
