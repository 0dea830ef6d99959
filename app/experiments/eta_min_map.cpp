// Section 4.2, (22)-(25): where the loop is stable, over eta and how stiff the hand holds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/excitation.h"
#include "app/experiments/harmonics.h"
#include "app/experiments/series.h"
#include "app/run/analysis.h"

namespace limpid {
namespace {

constexpr double kEtaStep = 0.05;
constexpr double kKick = 2e-5;     // how far the hand jumps at first, in each direction [m]
constexpr double kSeconds = 1.5;
constexpr double kPhysicsStep = 5e-5;  // of the device's integration [s]

constexpr const char* kFree = R"(title = "Free space"
about = "Nothing to touch."
)";

std::vector<double> etas() {
  std::vector<double> values;
  for (int i = 1; i <= 20; ++i) values.push_back(kEtaStep * i);
  return values;
}
std::vector<double> grips() {
  std::vector<double> values;
  for (int i = 0; i <= 12; ++i) values.push_back(30 * std::pow(10, i / 4.0));
  return values;
}

Vec3 start() { return {0.19, 0, 0}; }

Parameters parameters(double T, double eta, double grip) {
  Parameters p;
  p.tick = T;
  p.substeps = static_cast<int>(std::lround(T / kPhysicsStep));
  p.eta = eta;
  p.hand_stiffness = grip;
  p.hand_damping = 0;
  return p;
}

Trial kicked(double T, double eta, double grip) {
  const auto at = [](double t) {
    return Vec3(start() + (t > 0 ? kKick : 0) * Vec3(1, 1, 1));
  };
  return {fmt::format("T-{}-eta-{:.2f}-grip-{:.0f}", T, eta, grip),
          plan_in(kFree, hand_path("a jump", T, kSeconds, at), parameters(T, eta, grip)), false};
}

// Speeds over spans of a twentieth of the run: growing, or not dying away, is unstable.
bool stable(const TrialResult& result) {
  if (result.end.diverged) return false;
  const Session& s = result.session;
  const std::size_t spans = 20, rows = s.size() / spans;
  std::vector<double> speed;
  for (std::size_t i = 0; i < spans; ++i) {
    speed.push_back(rms_norm(s, Column::device_velocity, i * rows, (i + 1) * rows));
  }
  return speed.back() < speed.front() && speed.back() < speed[spans / 2];
}

struct Map {
  std::vector<double> grips, etas;
  std::vector<bool> stable;  // grips x etas
  bool at(std::size_t grip, std::size_t eta) const { return stable[grip * etas.size() + eta]; }
};

Map simulate_map(Laboratory& lab, double T) {
  Map map{grips(), etas(), {}};
  std::vector<Trial> trials;
  for (const double grip : map.grips) {
    for (const double eta : map.etas) trials.push_back(kicked(T, eta, grip));
  }
  std::vector<char> found(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { found[i] = stable(r) ? 1 : 0; });
  map.stable.assign(found.begin(), found.end());
  return map;
}

// Routh's limit in a grip, and (25), with b = b_d + b_v + extra.
double routh(const ArmDescription& arm, const Eigen::VectorXd& x, double grip, double extra) {
  Parameters p = parameters(1e-3, 1, grip);
  p.b_v += extra;
  return analyze(arm, x, p, std::nullopt).eta_min_grip;
}
}  // namespace

Outcome eta_min_map(Laboratory& lab) {
  const Trial any = kicked(1e-3, 1, 300);
  const Eigen::VectorXd x = rest_at(any.plan.arm, start()).x1;
  for (double T : {1e-3, 1e-4}) {
    Map map = simulate_map(lab, T);
    for (std::size_t g = 0; g < map.grips.size(); ++g) {
      fmt::print("T {} grip {:7.0f} routh {:.3f} {:.3f} ", T, map.grips[g], routh(any.plan.arm, x, map.grips[g], 0), routh(any.plan.arm, x, map.grips[g], 10 * T / 2));
      for (std::size_t e = 0; e < map.etas.size(); ++e) fmt::print("{}", map.at(g, e) ? '+' : '-');
      fmt::print("\n");
    }
  }
  return {};
}
}
