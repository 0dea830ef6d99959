// Section 3.1: a contact pressed beyond the torque limit and pulled out of, with and without the
// remedy against wind-up.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/experiment.h"
#include "app/experiments/signals.h"
#include "app/experiments/tap_bench.h"
#include "devices/simulated/random_corner.h"

namespace limpid {

namespace {

// Distribution of random corners, and their bounds. Tests of the rig run some hundreds of each;
// these are the first.
struct CornerSet {
  const char* label;  // empty: the arm's name
  const char* ink;
  CornerWidth width;
  unsigned first, count;  // seeds
  double most_torque;     // of the contacts, over the motors' limit [-]
};
constexpr CornerSet kCornerSets[] = {
    {"", kPredictiveInk, {}, 0, 120, 1.3},
    {"other arms, more walls, any eta", kDeviceInk, kWideCorners, 1000, 48, 1.6}};
constexpr double kMostEnergy = 5e-5, kMostJump = 0.01;  // [J], [rad]

Trial corner_trial(const ExperimentArm& on, const LimitedCorner& corner, unsigned seed) {
  Trial trial{"", {}};
  trial.keep = false;
  RunPlan& plan = trial.plan;
  plan.arm = corner.arm;
  plan.document.scene = corner.scene;
  plan.hand = hand_path(fmt::format("into the corner {}", seed), corner.p.tick,
                        LimitedCorner::kLasts, [&](double t) { return corner.hand(t); });
  plan.parameters = corner.p;
  if (corner.arm.dof() == on.description.dof()) {  // then it is this arm
    plan.parameters.encoder_step = on.settings.encoder_step;
    plan.parameters.device_delay = on.settings.device_delay;
    plan.parameters.delay = on.settings.delay;
  }
  plan.start = corner.start;
  plan.rows = plan.hand.time.size();
  return trial;
}

// Worst values of a run, or of many.
struct Cornered {
  double energy = 0;          // highest E_c [J]
  double port = 0;            // most that the hand was given [J]
  double torque = 0;          // largest of the contacts on a joint, over the motor's limit [-]
  double jump = 0;            // farthest that the proxy's joints go in a tick [rad]
  double reserve = HUGE_VAL;  // least [J]
  bool at_limit = false;      // a motor reached its limit

  void add(const Cornered& other) {
    energy = worse(energy, other.energy);
    port = worse(port, other.port);
    torque = worse(torque, other.torque);
    jump = worse(jump, other.jump);
    reserve = worse_low(reserve, other.reserve);
  }
};

Cornered cornered(const Session& s, double limit) {
  Cornered c;
  for (std::size_t k = 0; k < s.size(); ++k) {
    c.energy = worse(c.energy, s.at(k, Column::energy_total)[0]);
    c.port = worse(c.port, s.at(k, Column::energy_port)[0]);
    c.reserve = worse_low(c.reserve, s.at(k, Column::energy_ledger)[0]);
    c.torque =
        worse(c.torque, vector_at(s, k, Column::contact_torque).cwiseAbs().maxCoeff() / limit);
    c.at_limit = c.at_limit || vector_at(s, k, Column::motor_torque).cwiseAbs().maxCoeff() >= limit;
    if (k == 0) continue;
    const Eigen::VectorXd moved =
        vector_at(s, k, Column::proxy_position) - vector_at(s, k - 1, Column::proxy_position);
    c.jump = worse(c.jump, moved.cwiseAbs().maxCoeff());
  }
  return c;
}

void judge(const CornerSet& set, const std::string& label, const Cornered& worst, int at_limit,
           std::vector<Check>& checks) {
  const std::string where = fmt::format("{} corners, {}: ", set.count, label);
  checks.push_back(
      at_least(where + "runs in which a motor met its limit", at_limit, set.count / 3));
  checks.push_back(at_most(where + "highest E_c [J]", worst.energy, kMostEnergy));
  checks.push_back(
      at_most(where + "largest energy given to the human [J]", worst.port, kMostEnergy));
  checks.push_back(at_most(where + "largest contact torque, divided by the motors' limit",
                           worst.torque, set.most_torque));
  checks.push_back(
      at_most(where + "longest step of the proxy in a tick [rad]", worst.jump, kMostJump));
  checks.push_back(at_least(where + "lowest reserve of the energy account [J]", worst.reserve, 0));
}

constexpr double kLimit = 0.2;  // of every motor [N m]
constexpr double kPushLimit = 0.4;
constexpr double kEta = 0.6;
constexpr double kSurface = -0.04, kDeepest = -0.055, kAhead = 0.19;        // [m]
constexpr double kReached = 0.5, kPullOut = 1.2, kOut = 1.35, kOver = 1.7;  // [s]
constexpr double kHeldFrom = 0.8;  // everything at rest [s]
constexpr int kShoulder = 1;       // the joint that bears most of the press

Trial press(const ExperimentArm& on, const std::string& name, CouplingKind kind, bool anti_windup) {
  Parameters p = on.settings;
  p.kind = kind;
  p.eta = kEta;
  p.anti_windup = anti_windup;
  p.torque_limit = kLimit;
  const auto at = [](double t) {
    const double part =
        minimum_jerk(t / kReached) - minimum_jerk((t - kPullOut) / (kOut - kPullOut));
    return Vec3(kAhead, 0, kDeepest * part);
  };
  const std::string source =
      fmt::format("the hand moves down to {} m in {} s, and from {} s on moves back in {} s",
                  kDeepest, kReached, kPullOut, kOut - kPullOut);
  return {name, plan_in(on.description, kTableScene, hand_path(source, p.tick, kOver, at), p)};
}

// A run, and the quantities judged.
class Run {
 public:
  Run(const Trial& trial, const TrialResult& result)
      : arm_(trial.plan.arm), session_(result.session) {}

  const Session& session() const { return session_; }
  double shoulder(std::size_t k, Column column) const { return session_.at(k, column)[kShoulder]; }
  // Depth of the tip below the surface [mm].
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
  // Rms over [from, to) [s].
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
  // Torque with which the hand has to pull the shoulder up to get out [N m].
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

// Worst result over walls and etas of the predictive coupling, pushed with 8 N against motors of
// 0.4 N m.
Touch worst_push(TrialRunner& lab) {
  std::vector<TapBench> benches;
  std::vector<Trial> trials;
  for (const double wall : {600.0, 5000.0}) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      const TapSetting s{.eta = eta, .press = 8, .torque_limit = kPushLimit};
      benches.emplace_back(lab.arm(), s, wall, 300, 1);
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
      curve(without, "estimate, no anti-windup", kProposedTint, dashed,
            Column::hand_torque_estimate),
      curve(without, "true, no anti-windup", kProposedTint, line, Column::hand_torque),
      curve(with, "estimate, anti-windup", kProposedInk, dashed, Column::hand_torque_estimate),
      curve(with, "true, anti-windup", kProposedInk, line, Column::hand_torque),
      curve(predicted, "true, predictive", kPredictiveInk, line, Column::hand_torque)};
  FigurePanel motors{.title = "Torque of the shoulder's motor, commanded and given",
                     .x_label = "time [s]",
                     .y_label = "tau1 [N m]"};
  motors.series = {
      curve(without, "commanded, no anti-windup", kProposedTint, dashed, Column::commanded_torque),
      curve(with, "commanded, anti-windup", kProposedInk, dashed, Column::commanded_torque),
      curve(without, "given, no anti-windup", kProposedTint, line, Column::motor_torque),
      curve(with, "given, anti-windup", kProposedInk, line, Column::motor_torque),
      curve(predicted, "given, predictive", kPredictiveInk, line, Column::motor_torque)};
  FigurePanel lurking{.title = "Depth of device and proxy in the table, under each coupling",
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
  out.title = "Human torque at the shoulder while the hand pulls out";
  out.x_range = {kPullOut, 1.45};
  return {human, motors, lurking, out};
}

}  // namespace

void press_into_corners(TrialRunner& lab, Outcome& outcome) {
  const ExperimentArm& on = lab.arm();
  FigurePanel torque{.title = "Tip pressed into random corners of walls: contact torque",
                     .x_label = "limit of every motor [N m]",
                     .y_label = "largest contact torque / limit [-]"};
  FigurePanel jump{.title = "Tip pressed into random corners of walls: the proxy's steps",
                   .x_label = "limit of every motor [N m]",
                   .y_label = "longest step in a tick [mrad]"};
  torque.x_range = jump.x_range = {0.08, 0.62};
  torque.y_range = {0, 2};
  jump.y_range = {0, 14};
  for (const CornerSet& set : kCornerSets) {
    const std::string label = *set.label != '\0' ? set.label
                              : on.built_in()    ? "built-in arm"
                                                 : on.name;
    std::vector<LimitedCorner> corners;
    std::vector<Trial> trials;
    for (unsigned i = 0; i < set.count; ++i) {
      corners.push_back(limited_corner(set.first + i, set.width, on.description));
      trials.push_back(corner_trial(on, corners.back(), set.first + i));
    }
    std::vector<Cornered> found(trials.size());
    lab.run(trials, [&](std::size_t i, const TrialResult& r) {
      found[i] = cornered(r.session, corners[i].limit);
    });
    Series torques{label, set.ink, Series::Style::points, {}}, jumps = torques;
    Cornered worst;
    int at_limit = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      worst.add(found[i]);
      at_limit += found[i].at_limit;
      torques.points.push_back({corners[i].limit, found[i].torque});
      jumps.points.push_back({corners[i].limit, 1e3 * found[i].jump});
    }
    torque.series.push_back(torques);
    torque.series.push_back({fmt::format("bound, {}", label),
                             set.ink,
                             Series::Style::dashed,
                             {{0.08, set.most_torque}, {0.62, set.most_torque}}});
    jump.series.push_back(jumps);
    judge(set, label, worst, at_limit, outcome.checks);
  }
  jump.series.push_back({"bound",
                         kNeutralInk,
                         Series::Style::dashed,
                         {{0.08, 1e3 * kMostJump}, {0.62, 1e3 * kMostJump}}});
  outcome.figure.panels.push_back(torque);
  outcome.figure.panels.push_back(jump);
}

Outcome saturation(TrialRunner& lab) {
  using enum CouplingKind;
  const ExperimentArm& on = lab.arm();
  const std::vector<Trial> trials{
      press(on, "anti-windup", proposed, true), press(on, "wound-up", proposed, false),
      press(on, "standard", standard, true), press(on, "predictive", predictive, true)};
  const std::vector<TrialResult> results = lab.run(trials);
  const Run with(trials[0], results[0]), without(trials[1], results[1]),
      spring(trials[2], results[2]), predicted(trials[3], results[3]);

  Outcome outcome;
  outcome.figure.title =
      "The hand presses beyond the torque limit, holds, and pulls out of the contact";
  outcome.figure.caption = fmt::format(
      "Proposed and predictive coupling at the {}, eta = {}, motors limited to {} N m, table 600 "
      "N/m. With anti-windup the observer is told the torque that the motors gave. Without "
      "anti-windup the observer is told the commanded torque. Last two panels: under the "
      "predictive coupling the tip is pressed into a corner of one to six planes of 100 to 10,000 "
      "N/m, rough or smooth, and moved along it, with motors of 0.1 to 0.6 N m. Each point is one "
      "corner. Corner, arm, grip and eta are chosen at random.",
      on.gains(), kEta, kLimit);
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
      at_most("anti-windup, while the hand holds: rms error of the estimate, divided by the rms of "
              "the true torque",
              error(with, kHeldFrom, kPullOut) / human(with), 0.02),
      at_least("no anti-windup, while the hand holds: rms of the estimated torque divided by rms "
               "of the true torque",
               estimated(without) / human(without), 2),
      at_most("no anti-windup: deviation of the estimate from the paper's d - (tau_c - tau_m), "
              "divided by the estimate",
              without.off_the_law(), 0.02),
      at_least("pull-out: rms error of the estimate without anti-windup, divided by the error with "
               "anti-windup",
               error(without, kPullOut, kOut) / error(with, kPullOut, kOut), 3),
      at_least("pull-out: largest pull of the hand without anti-windup, divided by the pull with "
               "anti-windup",
               without.largest_pull() / with.largest_pull(), 1.2),
      at_least(
          "pull-out: largest pull of the hand, proposed with anti-windup divided by predictive",
          with.largest_pull() / predicted.largest_pull(), 1.2)};
  const Touch push = worst_push(lab);
  const std::string where = "predictive, pushed with 8 N, motors of 0.4 N m: ";
  outcome.checks.push_back(at_most(where + "highest E_c [J]", push.energy, 5e-5));
  outcome.checks.push_back(at_most(where + "largest contact torque, divided by the motors' limit",
                                   push.torque / kPushLimit, 1.3));
  outcome.checks.push_back(at_most(where + "chatter [m/s]", push.chatter, 1e-4));
  press_into_corners(lab, outcome);
  return outcome;
}

}  // namespace limpid
