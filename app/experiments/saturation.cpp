// Section 3.1: a contact pressed beyond the torque limit and pulled out of, with and without the
// remedy against wind-up.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/excitation.h"
#include "app/experiments/limited_corners.h"
#include "app/experiments/series.h"
#include "app/experiments/tap_bench.h"

namespace limpid {
namespace {

constexpr double kLimit = 0.2;  // of every motor [N m]
constexpr double kPushLimit = 0.4;
constexpr double kEta = 0.6;
constexpr double kSurface = -0.04, kDeepest = -0.055, kAhead = 0.19;        // [m]
constexpr double kReached = 0.5, kPullOut = 1.2, kOut = 1.35, kOver = 1.7;  // [s]
constexpr double kHeldFrom = 0.8;  // everything at rest [s]
constexpr int kShoulder = 1;       // the joint that bears most of it

Trial press(const std::string& name, CouplingKind kind, bool anti_windup) {
  Parameters p;
  p.kind = kind;
  p.eta = kEta;
  p.anti_windup = anti_windup;
  p.torque_limit = kLimit;
  const auto at = [](double t) {
    const double part =
        minimum_jerk(t / kReached) - minimum_jerk((t - kPullOut) / (kOut - kPullOut));
    return Vec3(kAhead, 0, kDeepest * part);
  };
  const std::string source = fmt::format("down to {} m in {} s, from {} s back within {} s",
                                         kDeepest, kReached, kPullOut, kOut - kPullOut);
  return {name, plan_in(kTableScene, hand_path(source, p.tick, kOver, at), p)};
}

// One run and what is asked of it.
class Run {
 public:
  Run(const Trial& trial, const TrialResult& result)
      : arm_(trial.plan.arm), session_(result.session) {}

  const Session& session() const { return session_; }
  double shoulder(std::size_t k, Column column) const { return session_.at(k, column)[kShoulder]; }
  // Of the tip below the surface [mm].
  double depth(std::size_t k, Column column) const {
    return 1e3 * (kSurface - tip_at(arm_, vector_at(session_, k, column)).z());
  }
  double estimate_error(std::size_t k) const {
    return (vector_at(session_, k, Column::hand_torque_estimate) -
            vector_at(session_, k, Column::hand_torque))
        .norm();
  }
  std::size_t row(double t) const {
    return std::min(session_.size(), static_cast<std::size_t>(t / session_.info.tick));
  }
  // rms over [from, to) [s].
  template <class Value>
  double rms(double from, double to, const Value& value) const {
    double sum = 0;
    for (std::size_t k = row(from); k < row(to); ++k) sum += value(k) * value(k);
    return std::sqrt(sum / static_cast<double>(row(to) - row(from)));
  }
  // |f1_hat - (f1 - (tau_c - tau_m))| over |f1_hat| while held, signs as in (16).
  double off_the_law() const {
    const std::size_t k = row(kPullOut) - 1;
    const auto of = [&](Column column) { return vector_at(session_, k, column); };
    const Eigen::VectorXd excess = of(Column::commanded_torque) - of(Column::motor_torque);
    const Eigen::VectorXd estimate = of(Column::hand_torque_estimate);
    return (estimate - (of(Column::hand_torque) - excess)).norm() / estimate.norm();
  }
  // How hard the hand has to pull the shoulder up to get out [N m].
  double largest_pull() const {
    double pull = 0;
    for (std::size_t k = row(kPullOut); k < session_.size(); ++k) {
      pull = std::max(pull, -shoulder(k, Column::hand_torque));
    }
    return pull;
  }

 private:
  const ArmDescription& arm_;
  const Session& session_;
};

// The predictive coupling pushed with 8 N against motors of 0.4 N m: the worst over walls and etas.
Touch worst_push(Laboratory& lab) {
  std::vector<TapBench> benches;
  std::vector<Trial> trials;
  for (const double wall : {600.0, 5000.0}) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      const TapSetting s{.eta = eta, .press = 8, .torque_limit = kPushLimit};
      benches.emplace_back(s, wall, 300, 1);
      trials.push_back(benches.back().trial());
    }
  }
  std::vector<Touch> touches(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { touches[i] = benches[i].touch(r); });
  Touch worst;
  for (const Touch& t : touches) {
    worst.energy = worse(worst.energy, t.energy);
    worst.chatter = worse(worst.chatter, t.chatter);
    worst.torque = worse(worst.torque, t.torque);
  }
  return worst;
}

std::vector<FigurePanel> panels(const Run& with, const Run& without, const Run& standard,
                                const Run& predicted) {
  using enum Series::Style;
  const auto curve = [](const Run& run, const std::string& label, const char* ink,
                        Series::Style style, Column column) {
    return over_time(run.session(), label, ink, style,
                     [&](std::size_t k) { return run.shoulder(k, column); });
  };
  const auto depth = [](const Run& run, const std::string& label, const char* ink,
                        Series::Style style, Column column) {
    return over_time(run.session(), label, ink, style,
                     [&](std::size_t k) { return run.depth(k, column); });
  };
  FigurePanel human{
      .title = "Human torque at the shoulder", .x_label = "time [s]", .y_label = "f1 [N m]"};
  human.series = {
      curve(without, "estimate, wound up", kProposedTint, dashed, Column::hand_torque_estimate),
      curve(without, "true, wound up", kProposedTint, line, Column::hand_torque),
      curve(with, "estimate, anti-windup", kProposedInk, dashed, Column::hand_torque_estimate),
      curve(with, "true, anti-windup", kProposedInk, line, Column::hand_torque),
      curve(predicted, "true, predictive", kPredictiveInk, line, Column::hand_torque)};
  FigurePanel motors{.title = "Torque asked of the shoulder's motor, and given",
                     .x_label = "time [s]",
                     .y_label = "tau1 [N m]"};
  motors.series = {
      curve(without, "asked, wound up", kProposedTint, dashed, Column::commanded_torque),
      curve(with, "asked, anti-windup", kProposedInk, dashed, Column::commanded_torque),
      curve(without, "given, wound up", kProposedTint, line, Column::motor_torque),
      curve(with, "given, anti-windup", kProposedInk, line, Column::motor_torque),
      curve(predicted, "given, predictive", kPredictiveInk, line, Column::motor_torque)};
  FigurePanel lurking{
      .title = "The proxy goes into the table with the device; the predictive one not",
      .x_label = "time [s]",
      .y_label = "tip below the surface [mm]"};
  lurking.series = {
      depth(with, "device, proposed", kProposedInk, line, Column::device_position),
      depth(with, "proxy, proposed", kProposedInk, dashed, Column::proxy_position),
      depth(predicted, "device, predictive", kPredictiveInk, line, Column::device_position),
      depth(predicted, "proxy, predictive", kPredictiveInk, dashed, Column::proxy_position),
      depth(standard, "device, standard", kStandardInk, line, Column::device_position),
      depth(standard, "proxy, standard", kStandardInk, dashed, Column::proxy_position)};
  lurking.y_range = {-10, 15};
  FigurePanel out = human;
  out.title = "Human torque at the shoulder while pulling out";
  out.x_range = {kPullOut, 1.45};
  return {human, motors, lurking, out};
}

}  // namespace

Outcome saturation(Laboratory& lab) {
  using enum CouplingKind;
  const std::vector<Trial> trials{
      press("anti-windup", proposed, true), press("wound-up", proposed, false),
      press("standard", standard, true), press("predictive", predictive, true)};
  const std::vector<TrialResult> results = lab.run(trials);
  const Run with(trials[0], results[0]), without(trials[1], results[1]),
      spring(trials[2], results[2]), predicted(trials[3], results[3]);

  Outcome outcome;
  outcome.figure.title = "A contact pressed beyond the torque limit, held and pulled out of";
  outcome.figure.caption = fmt::format(
      "Proposed and predictive coupling at the paper's gains, eta = {}, motors limited to {} N m, "
      "table 600 N/m. "
      "Anti-windup: the observer is told the torque the motors gave; wound up: the torque asked of "
      "them. Last two panels: the predictive coupling's tip pressed into a corner of one to six "
      "planes of 100 to 10,000 N/m, rough or smooth, and rubbed along it, with motors of 0.1 to "
      "0.6 N m; each point is one corner, drawn at random, as are arm, grip and eta.",
      kEta, kLimit);
  outcome.figure.columns = 2;
  outcome.figure.panels = panels(with, without, spring, predicted);

  const auto estimated = [](const Run& run) {
    return rms_norm(run.session(), Column::hand_torque_estimate, run.row(kHeldFrom),
                    run.row(kPullOut));
  };
  const auto human = [](const Run& run) {
    return rms_norm(run.session(), Column::hand_torque, run.row(kHeldFrom), run.row(kPullOut));
  };
  const auto error = [](const Run& run, double from, double to) {
    return run.rms(from, to, [&](std::size_t k) { return run.estimate_error(k); });
  };
  outcome.checks = {
      at_most("anti-windup: rms error of the estimate while held, over the rms true torque",
              error(with, kHeldFrom, kPullOut) / human(with), 0.02),
      at_least("wound up: rms estimate while held over rms true torque, at least",
               estimated(without) / human(without), 2),
      at_most("wound up: estimate off the paper's d - (tau_c - tau_m), of the estimate",
              without.off_the_law(), 0.02),
      at_least("pull-out: rms error of the estimate wound up over that with anti-windup, at least",
               error(without, kPullOut, kOut) / error(with, kPullOut, kOut), 3),
      at_least("pull-out: largest pull of the hand wound up over that with anti-windup, at least",
               without.largest_pull() / with.largest_pull(), 1.2),
      at_least("pull-out: largest pull of the hand, proposed with anti-windup over predictive, at "
               "least",
               with.largest_pull() / predicted.largest_pull(), 1.2)};
  const Touch push = worst_push(lab);
  const std::string where = "predictive, pushed with 8 N, motors of 0.4 N m: ";
  outcome.checks.push_back(at_most(where + "highest E_c [J]", push.energy, 5e-5));
  outcome.checks.push_back(at_most(where + "largest contact torque over the motors' limit",
                                   push.torque / kPushLimit, 1.3));
  outcome.checks.push_back(at_most(where + "chatter [m/s]", push.chatter, 1e-4));
  press_into_corners(lab, outcome);
  return outcome;
}

}  // namespace limpid
