#include "app/experiments/sideways_bench.h"

#include <fmt/format.h>

#include <cmath>

namespace limpid {
namespace {

std::string world(double wall) {
  if (wall == 0) return "title = \"Free space\"\nabout = \"Nothing to touch.\"\n";
  return fmt::format(R"(title = "Wall"
about = "A wall beside the tip."

[[plane]]
name = "wall"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
stiffness = {:.1f}
)",
                     wall);
}

// How far beyond the wall the hand aims [m].
double aim(double wall) {
  return wall > 0 ? SidewaysBench::kPress * (1 / SidewaysBench::kGrip + 1 / wall) : 0;
}

Trial trial(const FeltSetting& setting, const std::string& source, double seconds,
            const std::function<Vec3(double)>& at) {
  Parameters p;
  p.kind = setting.kind;
  p.eta = setting.eta;
  p.tick = SidewaysBench::kTick;
  p.hand_stiffness = SidewaysBench::kGrip;
  p.hand_damping = setting.wall > 0 ? SidewaysBench::kGripDamping : 0;
  return {fmt::format("{}-eta-{}-wall-{}", name(p.kind), p.eta, setting.wall),
          plan_in(world(setting.wall), hand_path(source, SidewaysBench::kTick, seconds, at), p)};
}

}  // namespace

std::size_t SidewaysBench::settled() {
  return static_cast<std::size_t>(std::llround(kSettle / kTick));
}

Trial SidewaysBench::shaken(const FeltSetting& setting) const {
  const double press = aim(setting.wall);
  const auto at = [&](double t) {
    return Vec3(kArm, shaking_.at(t) - press * minimum_jerk(t / (kSettle / 2)), 0);
  };
  const std::string source =
      fmt::format("shaking from {} to {} Hz at {} m/s, pressing {:.4g} m, seed {}", kLowest,
                  kHighest, kSpeed, press, seed_);
  return trial(setting, source, kSettle + kPeriod + kTick, at);
}

Trial SidewaysBench::pressed(const FeltSetting& setting) const {
  const double press = aim(setting.wall);
  const auto at = [&](double t) { return Vec3(kArm, -press * minimum_jerk(t / 0.5), 0); };
  Trial press_only = trial(setting, fmt::format("pressing {:.4g} m", press), 1.5, at);
  press_only.keep = false;
  return press_only;
}

}  // namespace limpid
