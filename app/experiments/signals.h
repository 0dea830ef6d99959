// Hands and worlds for single experiments, and signals of known frequencies.
#pragma once

#include <complex>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/experiments/experiment.h"
#include "app/run/simulate.h"

namespace limpid {

// Sines at whole multiples of a base frequency, so that whole periods of it hold whole periods of
// every sine.
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

// Minimum-jerk path from 0 at t = 0 to 1 at t = 1, at rest at both ends and beyond.
double minimum_jerk(double t);

// A hand that is at `at(t)` [m] at every tick for `seconds`. `source` names it in recordings; it
// must contain everything that decides the path.
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

// An arm in a world given as scene text, for the length of the hand's path.
RunPlan plan_in(const ArmDescription& arm, const std::string& scene_toml, HandPath hand,
                const Parameters& parameters);

// The inertia matrix [kg m^2] and the tip [m] at configuration x.
Eigen::MatrixXd inertia_at(const ArmDescription& arm, const Eigen::VectorXd& x);
Vec3 tip_at(const ArmDescription& arm, const Eigen::VectorXd& x);

// The complex amplitude of the part at frequency f [Hz] of samples T apart, first sample at t = 0:
// c cos(2 pi f t + p) gives c e^{jp}. Exact where the samples last whole periods of f.
std::complex<double> amplitude_at(const std::vector<double>& samples, double T, double f);

// Frequency where `value` over `f` (increasing) falls through `level`, interpolated in log f; 0 if
// it does not.
double falls_through(const std::vector<double>& f, const std::vector<double>& value, double level);

// Rate s of the least-squares fit of e^{s t} to positive samples T apart [1/s]: negative where they
// decay.
double growth_rate(const std::vector<double>& samples, double T);

// A trial of an arm: `scene` and `hand` name files of assets/ without folder.
RunPlan plan_of(const ArmDescription& arm, const std::string& scene, const std::string& hand,
                const Parameters& parameters);

// Number of ticks of the plan's hand.
std::uint64_t rows_of(const RunPlan& plan);

Eigen::VectorXd vector_at(const Session& session, std::size_t k, Column column);
// x1 - x2 at row k [rad].
Eigen::VectorXd coordination_error(const Session& session, std::size_t k);

// A curve over time, evenly thinned to `most` points.
Series over_time(const Session& session, const std::string& label, const std::string& color,
                 Series::Style style, const std::function<double(std::size_t k)>& value,
                 std::size_t most = 2000);

// Root mean square over the rows [from, to) of a vector column's norm.
double rms_norm(const Session& session, Column column, std::size_t from, std::size_t to);

// Least-squares slope of y on x through the origin.
double slope_through_origin(const std::vector<FigurePoint>& points);

}  // namespace limpid
