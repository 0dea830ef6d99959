// Hands and worlds made for one experiment, and signals of known frequencies.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/run/simulate.h"

namespace limpid {

// Sines at whole multiples of one frequency, so that a whole number of periods holds whole numbers
// of all of them.
struct Multisine {
  struct Line {
    int multiple = 1;      // of the base frequency
    double amplitude = 0;  // [m]
    double phase = 0;      // [rad]
  };
  double base = 1;  // [Hz]
  std::vector<Line> lines;

  double at(double t) const;
  double frequency(const Line& line) const { return base * line.multiple; }  // [Hz]
};

// About `count` lines from `low` to `high` [Hz], evenly spaced in the logarithm, each moving at
// most at `speed` [m/s], with phases drawn from `seed`.
Multisine multisine(double base, double low, double high, int count, double speed,
                    std::uint64_t seed);

// From 0 at t = 0 to 1 at t = 1, at rest at both ends and beyond: the minimum-jerk way.
double minimum_jerk(double t);

// A hand that is at `at(t)` [m] at every tick for `seconds`. `source` names it in recordings and
// must say all that decides the path.
HandPath hand_path(const std::string& source, double tick, double seconds,
                   const std::function<Vec3(double t)>& at);

inline constexpr const char* kTableScene = R"(title = "Table"
about = "A table top four centimetres below the middle of the workspace."

[[plane]]
name = "table top"
point = [0.2, 0.0, -0.04]
normal = [0.0, 0.0, 1.0]
stiffness = 600.0
)";

// The built-in arm in a world given as scene text, for as long as the hand lasts.
RunPlan plan_in(const std::string& scene_toml, HandPath hand, const Parameters& parameters);

// The inertia matrix [kg m^2] and the tip [m] at configuration x.
Eigen::MatrixXd inertia_at(const ArmDescription& arm, const Eigen::VectorXd& x);
Vec3 tip_at(const ArmDescription& arm, const Eigen::VectorXd& x);

}  // namespace limpid
