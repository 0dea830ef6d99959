#include "app/experiments/signals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "app/base/folders.h"
#include "core/dynamics/arm.h"
#include "core/math/elementary.h"
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
  // Distributions of the standard library differ between libraries, so none is used.
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

RunPlan plan_in(const ArmDescription& arm, const std::string& scene_toml, HandPath hand,
                const Parameters& parameters) {
  RunPlan plan;
  plan.arm = arm;
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

std::complex<double> amplitude_at(const std::vector<double>& samples, double T, double f) {
  const double step = 2 * std::numbers::pi * f * T;
  // The phase is turned on from sample to sample, and computed anew before round-off gathers.
  constexpr std::size_t kAnew = 64;
  const std::complex<double> turn = std::polar(1.0, -step);
  std::complex<double> sum = 0, at = 1;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    at = k % kAnew == 0 ? std::polar(1.0, -step * static_cast<double>(k)) : at * turn;
    sum += samples[k] * at;
  }
  return 2.0 * sum / static_cast<double>(samples.size());
}

double falls_through(const std::vector<double>& f, const std::vector<double>& value, double level) {
  for (std::size_t i = 1; i < f.size(); ++i) {
    if (value[i - 1] < level || value[i] >= level) continue;
    const double part = (value[i - 1] - level) / (value[i - 1] - value[i]);
    return f[i - 1] * std::pow(f[i] / f[i - 1], part);
  }
  return 0;
}

double growth_rate(const std::vector<double>& samples, double T) {
  const auto n = static_cast<double>(samples.size());
  double mean_log = 0;
  for (const double x : samples) mean_log += std::log(x) / n;
  double tt = 0, ty = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double t = (static_cast<double>(k) - (n - 1) / 2) * T;
    tt += t * t;
    ty += t * (std::log(samples[k]) - mean_log);
  }
  return ty / tt;
}

RunPlan plan_of(const ArmDescription& arm, const std::string& scene, const std::string& hand,
                const Parameters& parameters) {
  RunPlan plan;
  plan.arm = arm;
  plan.document = read_scene(data_dir() / "assets/scenes" / (scene + ".toml"), plan.arm);
  plan.hand = read_hand(data_dir() / "assets/hands" / (hand + ".csv"));
  plan.hand.source = "assets/hands/" + hand + ".csv";
  plan.parameters = parameters;
  plan.rows = rows_of(plan);
  return plan;
}

std::uint64_t rows_of(const RunPlan& plan) {
  return static_cast<std::uint64_t>(std::llround(plan.hand.duration() / plan.parameters.tick));
}

Eigen::VectorXd vector_at(const Session& session, std::size_t k, Column column) {
  const auto values = session.at(k, column);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd coordination_error(const Session& session, std::size_t k) {
  return vector_at(session, k, Column::device_position) -
         vector_at(session, k, Column::proxy_position);
}

Series over_time(const Session& session, const std::string& label, const std::string& color,
                 Series::Style style, const std::function<double(std::size_t k)>& value,
                 std::size_t most) {
  Series series{label, color, style, {}};
  const std::size_t step = std::max<std::size_t>(1, session.size() / most);
  for (std::size_t k = 0; k < session.size(); k += step) {
    series.points.push_back({session.at(k, Column::time)[0], value(k)});
  }
  return series;
}

double rms_norm(const Session& session, Column column, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += vector_at(session, k, column).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, to - from)));
}

double slope_through_origin(const std::vector<FigurePoint>& points) {
  double xy = 0, xx = 0;
  for (const FigurePoint& p : points) {
    xy += p.x * p.y;
    xx += p.x * p.x;
  }
  return xx > 0 ? xy / xx : 0;
}

}  // namespace limpid
