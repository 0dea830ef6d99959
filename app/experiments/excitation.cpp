#include "app/experiments/excitation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "app/base/assets.h"
#include "core/dynamics/arm.h"
#include "core/math/elementary.h"
#include "devices/files/arm/urdf_file.h"
#include "devices/files/scene/scene_file.h"

namespace limpid {

double Multisine::at(double t) const {
  double sum = 0;
  for (const Line& line : lines) {
    sum += line.amplitude * sine(2 * std::numbers::pi * frequency(line) * t + line.phase);
  }
  return sum;
}

Multisine multisine(double base, double low, double high, int count, double speed,
                    std::uint64_t seed) {
  // Not a distribution of the standard library: those differ between libraries.
  std::mt19937_64 random(seed);
  Multisine signal{base, {}};
  for (int i = 0; i < count; ++i) {
    const double wanted = low * power(high / low, static_cast<double>(i) / (count - 1));
    const int multiple = std::max(1, static_cast<int>(std::lround(wanted / base)));
    if (!signal.lines.empty() && multiple <= signal.lines.back().multiple) continue;
    const double phase = 2 * std::numbers::pi * static_cast<double>(random() >> 11) * 0x1p-53;
    signal.lines.push_back({multiple, speed / (2 * std::numbers::pi * base * multiple), phase});
  }
  return signal;
}

double minimum_jerk(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

HandPath hand_path(const std::string& source, double tick, double seconds,
                   const std::function<Vec3(double t)>& at) {
  HandPath path;
  path.source = source;
  path.tick = tick;
  const auto count = static_cast<std::size_t>(std::llround(seconds / tick));
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * tick;
    path.time.push_back(t);
    path.position.push_back(at(t));
    path.velocity.push_back((at(t + tick / 2) - at(t - tick / 2)) / tick);
    path.grip.push_back(1);
  }
  return path;
}

RunPlan plan_in(const std::string& scene_toml, HandPath hand, const Parameters& parameters) {
  RunPlan plan;
  plan.arm = read_urdf(default_device());
  plan.document = parse_scene(scene_toml, "scene", {}, plan.arm);
  plan.hand = std::move(hand);
  plan.parameters = parameters;
  plan.rows = plan.hand.time.size();
  return plan;
}

Eigen::MatrixXd inertia_at(const ArmDescription& description, const Eigen::VectorXd& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames frames;
  arm.frames(x, frames);
  Mat<kAnyDof> M;
  arm.inertia(frames, M);
  return M;
}

Vec3 tip_at(const ArmDescription& description, const Eigen::VectorXd& x) {
  return Arm<kAnyDof>(description).tip_at(x);
}

}  // namespace limpid
