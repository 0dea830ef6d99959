#include "app/desktop/panels/device_timing.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "app/desktop/panels/timing_panel.h"
#include "app/desktop/widgets/widgets.h"
#include "core/tick/safety_limits.h"

namespace limpid {
namespace {

constexpr double kReckonAgain = 0.25;  // [s]
constexpr double kSlow = 1.1;          // readings this many ticks apart are slower than the loop

std::string milliseconds(double seconds) { return fmt::format("{:.2f} ms", 1e3 * seconds); }

}  // namespace

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
                 ? fmt::format("Slower than the loop, {}: ticks in between see nothing new.",
                               milliseconds(p.tick))
                 : "",
             "How often the device says where it is");
    read_out("jitter",
             fmt::format("{}, 99 % within {}", milliseconds(f.jitter),
                         milliseconds(pace.intervals().quantile(0.99))),
             {}, "Deviation of the time between two readings, as they arrive here");
    draw_time_histogram(pace.intervals(), SafetyLimits::kStaleReading,
                        "Time between two readings, 1 us to 100 ms, both axes logarithmic; red: "
                        "over 5 ms, when force is cut.");
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
           "From a reading to the torque that answers it, beyond the tick. limpid identify finds "
           "it; without it the walls below are those of none.");
  const auto law = static_cast<std::size_t>(p.kind);
  const TipLimits::Wall& wall = now_.walls[law];
  const auto pair = [](double now, double prompt) {
    return fmt::format("{:.0f} of {:.0f} N/m", std::min(now, prompt), prompt);
  };
  read_out("stiffest wall", pair(wall.stiffness, prompt_.walls[law].stiffness), {},
           fmt::format("With this delay, of what {} would render without any. Bounded by {}.",
                       info(p.kind).key, wall.bound)
               .c_str());
  const double T = std::max(p.tick, pace.mean);
  read_out("passive in any hand",
           pair(every_hands_wall(now_.tip, T, now_.delay), prompt_.every_hand), {},
           "b_d / (T/2 + delay), T the longer of tick and readings: the stiffest wall that a "
           "linear law can render and be passive in every hand");
}

}  // namespace limpid
