#include "app/desktop/coupling/timing_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/desktop/widgets/widgets.h"
#include "app/style/palette.h"
#include "app/style/theme.h"
#include "core/tick/safety_limits.h"

namespace limpid {

namespace {

// Returns a number of late ticks and its share of all.
std::string of_all(std::int64_t count, std::int64_t ticks) {
  if (count == 0) return "0";
  const auto all = static_cast<double>(std::max<std::int64_t>(ticks, 1));
  return fmt::format("{} ({:.2g} %)", count, 100.0 * static_cast<double>(count) / all);
}

void draw_late_ticks(const LoopStatus& status, bool motors) {
  const LateTicks words = late_ticks(motors);
  read_out("late over 0.2 ms", of_all(status.late, status.ticks), {},
           "Ticks that began more than 0.2 ms after their deadline");
  read_out("missed", of_all(status.missed, status.ticks),
           status.missed > status.ticks / 100
               ? "More than 1 % of the ticks began more than one tick late. Close other programs, "
                 "or grant real-time priority (rtkit, or an rtprio limit)."
               : "",
           words.missed);
  read_out("slipped", of_all(status.slipped, status.ticks),
           status.slipped > 0 ? words.after_a_slip : "", words.slipped);
}

constexpr double kReckonAgain = 0.25;  // time between two computations [s]
constexpr double kSlow = 1.1;  // device is slower than the loop from so many ticks a reading on

std::string milliseconds(double seconds) { return fmt::format("{:.2f} ms", 1e3 * seconds); }

}  // namespace

void draw_time_histogram(const LatencyHistogram& histogram, double late, const char* help) {
  const Palette& colours = palette(current_theme());
  const float height = 32 * current_scale();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList* draw = ImGui::GetWindowDrawList();
  draw->AddRectFilled(at, {at.x + width, at.y + height}, colour(colours.frame, 0.5f), 3);
  constexpr int kBars = 50;
  constexpr int kPerBar = LatencyHistogram::kBins / kBars;
  std::array<double, kBars> columns{};
  double most = 1;
  for (int i = 0; i < LatencyHistogram::kBins; ++i) {
    double& column = columns[static_cast<std::size_t>(i / kPerBar)];
    column += static_cast<double>(histogram.count_in(i));
    most = std::max(most, column);
  }
  const float step = width / kBars;
  for (int i = 0; i < kBars; ++i) {
    const double share = columns[static_cast<std::size_t>(i)];
    if (share == 0) continue;
    const auto tall = static_cast<float>(std::log1p(share) / std::log1p(most)) * (height - 4);
    const float x = at.x + step * static_cast<float>(i);
    const bool too_late = LatencyHistogram::upper_edge(i * kPerBar) > late;
    draw->AddRectFilled({x, at.y + height - tall}, {x + step - 1, at.y + height},
                        colour(too_late ? colours.broken : colours.muted));
  }
  ImGui::Dummy({width, height});
  tooltip(help);
}

LateTicks late_ticks(bool motors) {
  if (motors) {
    return {"Ticks that began after the next tick was due",
            "Ticks skipped because the tick before began too late. With a motorised device the "
            "loop never runs skipped ticks later.",
            "A tick came too late. The loop skipped ticks that were due meanwhile, so that the "
            "motors never get several ticks at once. All later ticks come later by the skipped "
            "time."};
  }
  return {
      "Ticks that began after the next tick was due. The loop then runs faster until it is on time "
      "again.",
      "Ticks skipped because the loop stood still for too long",
      "The loop stood still for more than 20 ticks. Then it went on without the missed ticks. "
      "Simulated time is now behind real time by the skipped ticks."};
}

void draw_timing(const LiveLoop& loop, const std::string& quality, double frame_time) {
  const LoopStatus status = loop.status();
  read_out("haptic rate", fmt::format("{:.1f} Hz", status.rate),
           status.running ? std::string() : "The loop has stopped: " + status.failure);
  const LatencyHistogram& wake = loop.thread().wake_latency();
  read_out("wake-up p50 / p99",
           fmt::format("{:.0f} / {:.0f} us", 1e6 * wake.quantile(0.5), 1e6 * wake.quantile(0.99)),
           {}, "Time from a tick's deadline to the tick's begin");
  draw_time_histogram(wake, 1e-3,
                      "Wake-up latency of the haptic thread, 1 us to 100 ms. Both axes are "
                      "logarithmic. Red: longer than one tick.");
  const LatencyHistogram& compute = loop.thread().compute_time();
  read_out("tick takes p50 / p99", fmt::format("{:.0f} / {:.0f} us", 1e6 * compute.quantile(0.5),
                                               1e6 * compute.quantile(0.99)));
  draw_late_ticks(status, loop.device_in_place());
  read_out("scheduling",
           status.realtime.realtime() ? fmt::format("real-time {}", status.realtime.priority)
                                      : "ordinary",
           {}, status.realtime.explanation.c_str());
  const std::uint64_t dropped =
      loop.trace_dropped() + (loop.recording() ? loop.recorder()->dropped() : 0);
  if (dropped > 0) {
    read_out("ticks dropped", std::to_string(dropped),
             "Ticks that were lost because the buffer to the plots or the recording was full.");
  }
  read_out("picture quality", quality, {},
           "Set it in View > Picture quality. Automatic: the best quality that this computer draws "
           "smoothly");
  read_out("frame", fmt::format("{:.1f} ms", 1e3 * frame_time), {},
           "Time to draw one picture. The control loop does not wait for pictures.");
}

void DeviceTiming::draw(const DevicePace& pace, const ArmDescription& arm, const Parameters& p,
                        const Scene& scene, std::span<const double> x) {
  if (ImGui::GetTime() >= due_) {
    due_ = ImGui::GetTime() + kReckonAgain;
    const Eigen::VectorXd pose =
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    now_ = tip_limits(arm, pose, p, scene);
    prompt_ = without_delay(arm, pose, p, scene);
  }
  heading("The device");
  const DevicePace::Figures f = pace.figures();
  if (f.intervals == 0) {
    read_out("readings", "none yet");
  } else {
    read_out("readings", fmt::format("{:.0f} Hz, every {}", f.rate, milliseconds(f.mean)),
             f.mean > kSlow * p.tick
                 ? fmt::format("The readings come more slowly than the ticks of the loop ({}). "
                               "Ticks between two readings use the old position.",
                               milliseconds(p.tick))
                 : "",
             "How often the device reports its position");
    read_out("jitter",
             fmt::format("{}, 99 % within {}", milliseconds(f.jitter),
                         milliseconds(pace.intervals().quantile(0.99))),
             {}, "Standard deviation of the time between two readings, when Limpid gets them");
    draw_time_histogram(pace.intervals(), SafetyLimits::kStaleReading,
                        "Time between two readings, 1 us to 100 ms. Both axes are logarithmic. "
                        "Red: longer than 5 ms; then Limpid switches the force off.");
  }
  draw_cost(f, arm, p);
}

void DeviceTiming::draw_cost(const DevicePace::Figures& pace, const ArmDescription& arm,
                             const Parameters& p) const {
  const bool assumed = !arm.delay && p.delay == 0;
  read_out("delay",
           arm.delay ? milliseconds(*arm.delay) + ", measured"
           : assumed ? "not measured"
                     : milliseconds(p.delay * p.tick) + ", as set",
           {},
           "Delay from a reading to the torque computed from it. The tick is not included. `limpid "
           "identify` measures this delay. Without a measurement the walls below are computed "
           "without delay.");
  const TipWall& wall = now_.wall(p.kind);
  const auto pair = [](double now, double prompt) {
    return fmt::format("{:.0f} of {:.0f} N/m", std::min(now, prompt), prompt);
  };
  read_out(
      "stiffest wall", pair(wall.stiffness, prompt_.wall(p.kind).stiffness), {},
      fmt::format("First number: the stiffest wall with this delay. Second number: the stiffest "
                  "wall that the {} law would render without delay. Reason for the limit: {}.",
                  info(p.kind).key, wall.bound)
          .c_str());
  const double T = std::max(p.tick, pace.mean);
  read_out("stiffest passive wall",
           pair(every_hands_wall(now_.tip, T, now_.loop.delay), prompt_.every_hand), {},
           "b_d / (T/2 + delay) is the stiffest wall that a plain spring can render and still be "
           "passive in every hand. T is the tick or the time between two readings, whichever is "
           "longer.");
}

}  // namespace limpid
