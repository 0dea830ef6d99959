// Section 3.1: speed of the human force observer, for every gain.
#include "app/experiments/observer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/experiments/signals.h"
#include "core/math/eigen.h"

namespace limpid {

namespace {

constexpr double kPi = std::numbers::pi;

double lag(double w_f, double T) {
  constexpr double kPole = 1 - 1 / std::numbers::sqrt2;
  const double A = w_f * T;
  return (1 + (2 * kPole - 1) * A) / std::pow(1 + kPole * A, 2);
}

void add(Response& r, double f, std::complex<double> H) {
  double phase = std::arg(H);
  const double before = r.phase.empty() ? 0 : r.phase.back();
  phase -= 2 * kPi * std::round((phase - before) / (2 * kPi));
  r.f.push_back(f);
  r.gain.push_back(std::abs(H));
  r.phase.push_back(phase);
}

std::vector<double> along(const Session& s, std::size_t from, Column column,
                          const Eigen::VectorXd& u) {
  std::vector<double> values;
  for (std::size_t k = from; k < s.size(); ++k) values.push_back(u.dot(vector_at(s, k, column)));
  return values;
}

constexpr double kTick = 0.001;                  // [s]
constexpr double kPeriod = 5;                    // of the shaking; one to settle, one measured [s]
constexpr double kLowest = 0.2, kHighest = 200;  // [Hz]
constexpr double kSpeed = 5e-4;                  // of the shaking at each frequency [m/s]
constexpr double kUnsampled = 0.05;  // largest w_f T without a visible effect of sampling
constexpr double kShown[] = {0.0035, 0.035, 0.35};  // gains worth a curve [N m s/rad]

constexpr const char* kFree = R"(title = "Free space"
about = "Nothing to touch."
)";

Vec3 start() { return {0.19, 0, 0}; }

// An arm at its gains with eta = 1. The grip has no damper, which would answer to the
// steps in the target's rate from tick to tick.
RunPlan free_plan(const ExperimentArm& on, double alpha, HandPath hand) {
  Parameters p = on.settings;
  p.alpha = alpha;
  p.tick = kTick;
  p.hand_damping = 0;
  return plan_in(on.description, kFree, std::move(hand), p);
}

// Modes of the arm where the hand starts; each is an observer of its own.
struct Modes {
  Eigen::VectorXd m;  // lightest first [kg m^2]
  Eigen::MatrixXd u;  // columns, unit
};

Modes modes_of(const ArmDescription& arm) {
  const Eigen::MatrixXd M = inertia_at(arm, rest_at(arm, start()).x1);
  const SymmetricEigen solved = symmetric_eigen(M);
  return {solved.values, solved.vectors};
}

std::size_t ticks(double seconds) {
  return static_cast<std::size_t>(std::llround(seconds / kTick));
}

// A hand that shakes a little in all three directions, at the same frequencies.
class Shaking {
 public:
  explicit Shaking(std::uint64_t seed) {
    std::vector<Multisine> axes;
    for (std::uint64_t i = 0; i < 3; ++i) {
      axes.push_back(multisine(1 / kPeriod, kLowest, kHighest, 48, kSpeed, 3 * seed + i));
    }
    const std::string source =
        fmt::format("shaking from {} to {} Hz at {} m/s, seed {}", kLowest, kHighest, kSpeed, seed);
    path_ = hand_path(source, kTick, 2 * kPeriod, [&](double t) {
      return Vec3(start() + Vec3(axes[0].at(t), axes[1].at(t), axes[2].at(t)));
    });
    lines_ = axes.front();
  }
  const Multisine& lines() const { return lines_; }
  Trial trial(const ExperimentArm& on, double alpha, double seconds, bool keep) const {
    Trial trial{fmt::format("alpha-{:.3g}", alpha), free_plan(on, alpha, path_), keep};
    trial.plan.rows = std::min<std::uint64_t>(trial.plan.rows, ticks(seconds));
    return trial;
  }

 private:
  Multisine lines_;
  HandPath path_;
};

double off(double value, double wanted) { return std::abs(value / wanted - 1); }

// Draws and checks bandwidth over alpha / m for a sweep of gains and every mode of the arm.
void bandwidth(TrialRunner& lab, const Shaking& shaking, Outcome& outcome) {
  std::vector<double> gains;
  for (int i = 0; i <= 18; ++i) gains.push_back(0.002 * std::pow(500, i / 18.0));
  std::vector<Trial> trials;
  for (const double alpha : gains)
    trials.push_back(shaking.trial(lab.arm(), alpha, 2 * kPeriod, false));
  const Modes modes = modes_of(trials.front().plan.arm);

  Series by_gain{"gain -3 dB", kProxyInk, Series::Style::points, {}};
  Series by_phase{"phase -45 deg", kContactInk, Series::Style::points, {}};
  std::vector<double> f;
  for (double hertz = 0.1; hertz < 400; hertz *= 1.02) f.push_back(hertz);
  double off_fast = 0, off_sampled = 0;
  std::vector<Response> seen(trials.size() * 3);
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    for (int mode = 0; mode < 3; ++mode) {
      seen[3 * i + static_cast<std::size_t>(mode)] =
          measured_response(result.session, ticks(kPeriod), modes.u.col(mode), shaking.lines());
    }
  });
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double w_f = gains[i / 3] / modes.m[static_cast<Eigen::Index>(i % 3)];
    const Response sampled = sampled_response(f, w_f, kTick);
    const double w_gain = gain_bandwidth(seen[i]), w_phase = phase_bandwidth(seen[i]);
    by_phase.points.push_back({w_f, w_phase});
    off_sampled = worse(off_sampled, off(w_phase, phase_bandwidth(sampled)));
    // In the band of the shaking some gains have no bandwidth; compare where measurement or theory
    // has one.
    const bool falls = gain_bandwidth(sampled_response(seen[i].f, w_f, kTick)) > 0;
    if (w_gain > 0) by_gain.points.push_back({w_f, w_gain});
    if (w_gain > 0 || falls) {
      off_sampled = worse(off_sampled, off(w_gain, gain_bandwidth(sampled)));
      if (w_f * kTick <= kUnsampled) off_fast = worse(off_fast, off(w_gain, w_f));
    }
  }

  Series ideal{"alpha / m", kNeutralInk, Series::Style::dashed, {}};
  Series gain_line{"theory in ticks of 1 ms", kProxyInk, Series::Style::line, {}};
  Series phase_line{"", kContactInk, Series::Style::line, {}};
  for (double w_f = 3; w_f < 2e4; w_f *= 1.1) {
    const Response sampled = sampled_response(f, w_f, kTick);
    ideal.points.push_back({w_f, w_f});
    phase_line.points.push_back({w_f, phase_bandwidth(sampled)});
    if (const double w = gain_bandwidth(sampled); w > 0) gain_line.points.push_back({w_f, w});
  }
  FigurePanel panel;
  panel.title = "Bandwidth of the estimate, all modes, alpha 0.002 to 1";
  panel.x_label = "w_f = alpha / m [rad/s]";
  panel.y_label = "bandwidth [rad/s]";
  panel.log_x = panel.log_y = true;
  panel.x_range = {3, 2e4};
  panel.y_range = {3, 1e4};
  panel.series = {ideal, gain_line, phase_line, by_gain, by_phase};
  outcome.figure.panels.push_back(panel);
  outcome.checks.push_back(at_most(
      fmt::format("deviation of the -3 dB bandwidth from alpha / m where w_f T <= {}", kUnsampled),
      off_fast, 0.02));
  outcome.checks.push_back(at_most(
      "-3 dB and -45 degree bandwidths: deviation from equation (17) in ticks, all gains and modes",
      off_sampled, 0.03));
}

// Draws f1_hat over f1 along the heaviest mode for three gains.
void response(TrialRunner& lab, const Shaking& shaking, Outcome& outcome) {
  std::vector<Trial> trials;
  for (const double alpha : kShown)
    trials.push_back(shaking.trial(lab.arm(), alpha, 2 * kPeriod, true));
  const Modes modes = modes_of(trials.front().plan.arm);
  const std::vector<TrialResult> results = lab.run(trials);
  FigurePanel panel;
  panel.title = "Estimated / true human torque, heaviest mode (lines: theory)";
  panel.x_label = "frequency [Hz]";
  panel.y_label = "gain [-]";
  panel.log_x = panel.log_y = true;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const double w_f = kShown[i] / modes.m[2];
    const Response seen =
        measured_response(results[i].session, ticks(kPeriod), modes.u.col(2), shaking.lines());
    const Response sampled = sampled_response(seen.f, w_f, kTick);
    Series points{fmt::format("alpha = {}", kShown[i]), kFamilyInk[i], Series::Style::points, {}};
    Series theory{"", kFamilyInk[i], Series::Style::line, {}};
    for (std::size_t line = 0; line < seen.f.size(); ++line) {
      points.points.push_back({seen.f[line], seen.gain[line]});
      theory.points.push_back({seen.f[line], sampled.gain[line]});
    }
    panel.series.push_back(theory);
    panel.series.push_back(points);
  }
  outcome.figure.panels.push_back(panel);
}

// (18): decay of a wrong first estimate, in a hand that rests.
void error_decay(TrialRunner& lab, Outcome& outcome) {
  constexpr double kWrong = 1e-3;  // [N m]
  std::vector<Trial> trials;
  for (const double alpha : kShown) {
    const auto still = [](double) { return start(); };
    RunPlan plan = free_plan(lab.arm(), alpha, hand_path("at rest", kTick, 0.2, still));
    plan.start = rest_at(plan.arm, start());
    plan.start->f1_hat = kWrong * modes_of(plan.arm).u.rowwise().sum();
    trials.push_back({fmt::format("wrong-{:.3g}", alpha), std::move(plan), false});
  }
  const Modes modes = modes_of(trials.front().plan.arm);
  const std::vector<TrialResult> results = lab.run(trials);

  FigurePanel panel;
  panel.title = "Decay of a wrong estimate, heaviest mode (dashed: exp(-w_f t))";
  panel.x_label = "time [s]";
  panel.y_label = "|error| / |first error| [-]";
  panel.log_y = true;
  panel.x_range = {0, 0.1};
  panel.y_range = {1e-2, 1};
  double worst = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Session& s = results[i].session;
    for (Eigen::Index mode = 0; mode < 3; ++mode) {
      const double w_f = kShown[i] / modes.m[mode];
      Series seen{fmt::format("alpha = {}", kShown[i]), kFamilyInk[i], Series::Style::line, {}};
      Series ideal{"", kFamilyInk[i], Series::Style::dashed, {}};
      std::vector<double> errors;
      for (std::size_t k = 0; k < s.size(); ++k) {
        const double t = static_cast<double>(k) * kTick;
        const double error = std::abs(modes.u.col(mode).dot(
            vector_at(s, k, Column::hand_torque_estimate) - vector_at(s, k, Column::hand_torque)));
        // Keeps three errors even if they decay within a tick or two.
        if (error < 1e-2 * kWrong && errors.size() >= 3) break;
        errors.push_back(error);
        seen.points.push_back({t, error / kWrong});
        ideal.points.push_back({t, std::exp(-w_f * t)});
      }
      worst = worse(worst, off(-growth_rate(errors, kTick), sampled_decay(w_f, kTick)));
      if (mode == 2) panel.series.insert(panel.series.end(), {seen, ideal});
    }
  }
  outcome.figure.panels.push_back(panel);
  outcome.checks.push_back(
      at_most("decay rate of a wrong estimate: deviation from equation (18) in ticks, all modes",
              worst, 0.02));
}

// Checks that estimates stay bounded for gains over many decades.
void every_gain(TrialRunner& lab, const Shaking& shaking, Outcome& outcome) {
  std::vector<double> gains;
  for (int decade = -5; decade <= 3; ++decade) gains.push_back(std::pow(10.0, decade));
  std::vector<Trial> trials;
  for (const double alpha : gains) trials.push_back(shaking.trial(lab.arm(), alpha, 1, false));
  std::vector<double> ratio(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    double estimate = 0, human = 0;
    for (std::size_t k = 0; k < result.session.size(); ++k) {
      human = worse(human, vector_at(result.session, k, Column::hand_torque).norm());
      estimate = worse(estimate, vector_at(result.session, k, Column::hand_torque_estimate).norm());
    }
    ratio[i] = result.end.diverged ? HUGE_VAL : estimate / human;
  });
  FigurePanel panel;
  panel.title = "Largest estimated torque, divided by the largest true torque";
  panel.x_label = "alpha [N m s/rad]";
  panel.y_label = "max |f1_hat| / max |f1| [-]";
  panel.log_x = panel.log_y = true;
  Series points{"", kProxyInk, Series::Style::points, {}};
  for (std::size_t i = 0; i < gains.size(); ++i) points.points.push_back({gains[i], ratio[i]});
  panel.series = {points};
  outcome.figure.panels.push_back(panel);
  double largest = 0;
  for (const double one : ratio) largest = worse(largest, one);
  outcome.checks.push_back(
      at_most("largest estimated torque divided by largest true torque, alpha from 1e-5 to 1e3",
              largest, 1.1));
}

}  // namespace

double gain_bandwidth(const Response& response) {
  return 2 * kPi * falls_through(response.f, response.gain, std::numbers::sqrt2 / 2);
}

double phase_bandwidth(const Response& response) {
  return 2 * kPi * falls_through(response.f, response.phase, -kPi / 4);
}

Response measured_response(const Session& session, std::size_t from, const Eigen::VectorXd& u,
                           const Multisine& shaking) {
  const double T = session.info.tick;
  const std::vector<double> human = along(session, from, Column::hand_torque, u);
  const std::vector<double> estimate = along(session, from, Column::hand_torque_estimate, u);
  Response response;
  for (const Multisine::Line& line : shaking.lines) {
    const double f = shaking.frequency(line);
    // A row holds the mean torque over the tick that follows t_k.
    const double half = kPi * f * T;
    const std::complex<double> mean = std::polar(std::sin(half) / half, half);
    add(response, f, amplitude_at(estimate, T, f) * mean / amplitude_at(human, T, f));
  }
  return response;
}

Response sampled_response(const std::vector<double>& f, double w_f, double T) {
  const double E = lag(w_f, T);
  Response response;
  for (const double hertz : f) {
    const double half = kPi * hertz * T;
    const double sinc = std::sin(half) / half;
    const std::complex<double> delay = std::polar(1.0, -2 * half);
    add(response, hertz, sinc * sinc * delay * (1 - E) / (1.0 - E * delay));
  }
  return response;
}

// For fast modes the error changes its sign from tick to tick.
double sampled_decay(double w_f, double T) { return -std::log(std::abs(lag(w_f, T))) / T; }

Outcome observer(TrialRunner& lab) {
  const Shaking shaking(lab.seed());
  Outcome outcome;
  outcome.figure.title =
      "The human force observer: bandwidth, error and stability against its gain";
  outcome.figure.caption = fmt::format(
      "{} with its tip held {} m ahead in an undamped grip of 300 N/m, eta = 1, ticks of {} ms. "
      "The hand shakes with all frequencies from {} to {} Hz together. The modes are the modes of "
      "M at that pose.",
      lab.arm().heading(), start().x(), 1e3 * kTick, kLowest, kHighest);
  outcome.figure.columns = 2;
  bandwidth(lab, shaking, outcome);
  response(lab, shaking, outcome);
  error_decay(lab, outcome);
  every_gain(lab, shaking, outcome);
  return outcome;
}

}  // namespace limpid
