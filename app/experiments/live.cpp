// Live experiments: Figs. 3 to 6 and the stiffest wall, in a human hand.
#include "app/experiments/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "app/experiments/coordination.h"
#include "app/experiments/signals.h"
#include "app/experiments/tap_bench.h"
#include "app/run/analysis.h"
#include "app/run/provenance.h"
#include "core/dynamics/arm.h"
#include "core/math/eigen.h"
#include "core/math/high_pass.h"

namespace limpid {

// Defined below.
Outcome live_coordination(LiveLaboratory& lab);
Outcome live_inertia(LiveLaboratory& lab);
Outcome live_passivity(LiveLaboratory& lab);
Outcome live_zwidth(LiveLaboratory& lab);

namespace {

constexpr std::array kLiveExperiments{
    LiveExperiment{"coordination", "device and proxy while you press (Figs. 3 and 4)",
                   live_coordination},
    LiveExperiment{"inertia", "what you feel at three etas (Fig. 5)", live_inertia},
    LiveExperiment{"passivity",
                   "controller energy while you touch a surface and draw circles on it (Fig. 6)",
                   live_passivity},
    LiveExperiment{"zwidth", "the stiffest wall that does not vibrate in your hand", live_zwidth},
};

// Mean over `reach` rows to both sides, taken twice; shifts nothing in time.
std::vector<Eigen::VectorXd> smooth(const std::vector<Eigen::VectorXd>& raw, std::size_t reach) {
  std::vector<Eigen::VectorXd> values = raw;
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<Eigen::VectorXd> from = values;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(from.front().size());
    for (std::size_t k = 0; k < from.size() + reach; ++k) {
      if (k < from.size()) sum += from[k];
      if (k > 2 * reach) sum -= from[k - 2 * reach - 1];
      if (k < reach || k - reach >= from.size()) continue;
      const std::size_t first = k > 2 * reach ? k - 2 * reach : 0;
      const std::size_t last = std::min(k, from.size() - 1);
      values[k - reach] = sum / static_cast<double>(last - first + 1);
    }
  }
  return values;
}

constexpr double kSeconds = 20;
constexpr int kContacts = 3;

constexpr double kInertiaSeconds = 15;
constexpr double kMargin = 1.1;    // over the least passive eta
constexpr double kOff = 0.25;      // of the promised value: hands and arms differ
constexpr double kLargest = 1.75;  // eta

// Inertia by (24) in a slow hand: Z = eta (b + s m (1 + (1 - eta) b / alpha)). The estimate lags by
// m / alpha; the lag of its damping acts like inertia.
double promised_inertia(const Parameters& p, double b) {
  return p.eta * (1 + (1 - p.eta) * b / p.alpha);
}

LiveTrial swing(const Parameters& p) {
  return {fmt::format("eta-{:.2f}", p.eta), p, kInertiaSeconds,
          fmt::format("eta = {:.2f}: for 15 s, swing the tip through free space about once a "
                      "second. Touch nothing.",
                      p.eta)};
}

constexpr double kPassivitySeconds = 20;
constexpr double kHighestLive = 4e-3;  // from unknown steps of encoders and friction [J]

constexpr double kZwidthSeconds = 6;
constexpr double kSoft = 250;                 // the first wall [N/m]
constexpr std::size_t kZwidthTouching = 500;  // least rows in contact for a result

struct Wall {
  double stiffness, chatter;
  bool renders;
};

Wall tap(LiveLaboratory& lab, const Parameters& p, double stiffness) {
  lab.stiffen(stiffness);
  const Session s = lab.run({fmt::format("{}-{:.0f}", name(p.kind), stiffness), p, kZwidthSeconds,
                             fmt::format("Wall of {:.0f} N/m, {} coupling: for 6 s, tap the wall, "
                                         "press the tip into the wall, and hold the tip there.",
                                         stiffness, name(p.kind))});
  std::size_t touching = 0;
  for (std::size_t k = 0; k < s.size(); ++k) touching += contact_torque(s, k) > 0;
  if (touching < kZwidthTouching)
    throw std::runtime_error(
        "the tip hardly touched the wall; start the trial again and press the tip into the wall");
  const double chatter = chatter_in_contact(s, lab.arm);
  return {stiffness, chatter, chatter <= WellRendered::kChatter};
}

}  // namespace

std::span<const LiveExperiment> live_experiments() { return kLiveExperiments; }

Outcome carry_out(const LiveExperiment& experiment, LiveLaboratory& lab,
                  const std::filesystem::path& dir) {
  Outcome outcome = experiment.run(lab);
  Conditions conditions;
  conditions.add(lab.arm, lab.parameters);
  outcome.figure.caption += " " + conditions.of_the_device();
  outcome.figure.made_by = provenance(conditions.settings(), std::nullopt);
  write_outcome(live_name(experiment), outcome, dir);
  return outcome;
}

Felt felt_of(const Session& s, const ArmDescription& arm) {
  constexpr std::size_t kReach = 25;  // rows: passes a hand's few hertz, no tremor
  constexpr std::size_t kStep = 10;   // rows from one evaluation to the next
  if (s.size() < 8 * kReach)
    throw std::runtime_error(
        "the recording is too short to find the inertia felt; start the trial again");
  std::vector<Eigen::VectorXd> x, torque;
  for (std::size_t k = 0; k < s.size(); ++k) {
    x.push_back(vector_at(s, k, Column::device_position));
    torque.push_back(vector_at(s, k, Column::hand_torque_estimate));
  }
  x = smooth(x, kReach);
  torque = smooth(torque, kReach);
  const double T = s.info.tick;
  // Model: f1 = share M a + each joint's damping and steady push. Fitting these keeps them out of
  // the share.
  const Eigen::Index n = x[0].size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(1 + 2 * n, 1 + 2 * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(1 + 2 * n);
  for (std::size_t k = 3 * kReach; k + 3 * kReach < s.size(); k += kStep) {
    const double h = kStep * T;
    const Eigen::MatrixXd M = arm_at(arm, x[k]).M;
    Eigen::MatrixXd along(n, 1 + 2 * n);
    along.col(0) = M * (x[k + kStep] - 2 * x[k] + x[k - kStep]) / (h * h);
    along.middleCols(1, n) = ((x[k + kStep] - x[k - kStep]) / (2 * h)).asDiagonal();
    along.rightCols(n).setIdentity();
    // (17) without the observer's lag: f1 = f1_hat + M f1_hat' / alpha.
    const Eigen::VectorXd f1 = torque[k] + M * (torque[k + kStep] - torque[k - kStep]) /
                                               (2 * h * s.at(k, Column::alpha)[0]);
    normal += along.transpose() * along;
    right += along.transpose() * f1;
  }
  const Eigen::VectorXd found = least_squares(normal, right);
  return {found[0], found.segment(1, n)};
}

double chatter_in_contact(const Session& s, const ArmDescription& description) {
  const Arm<kAnyDof> arm(description);
  const double T = s.info.tick;
  HighPass fast[] = {{TapBench::kFast, 1 / T}, {TapBench::kFast, 1 / T}, {TapBench::kFast, 1 / T}};
  double sum = 0;
  std::size_t touching = 0;
  Vec3 before = arm.tip_at(vector_at(s, 0, Column::device_position));
  for (std::size_t k = 0; k < s.size(); ++k) {
    const Vec3 tip = arm.tip_at(vector_at(s, k, Column::device_position));
    Vec3 v = (tip - before) / T;
    before = tip;
    for (int i = 0; i < 3; ++i) v[i] = fast[i](v[i]);
    if (!(contact_torque(s, k) > 0)) continue;
    sum += v.squaredNorm();
    ++touching;
  }
  return touching > 0 ? std::sqrt(sum / static_cast<double>(touching)) : 0;
}

Outcome live_coordination(LiveLaboratory& lab) {
  struct Run {
    CouplingKind kind;
    const char* ink;
    Session session = {};
  };
  Run runs[] = {{CouplingKind::standard, kStandardInk}, {CouplingKind::proposed, kProposedInk}};
  Outcome outcome;
  Figure& figure = outcome.figure;
  figure.title = "Coordination of device and proxy in your hand";
  figure.caption =
      "The hand pressed the tip onto the surface and lifted it off, as often and as hard as the "
      "person liked.";
  figure.columns = 2;
  FigurePanel force{
      .title = "Contact torque |f2|", .x_label = "time [s]", .y_label = "torque [N m]"};
  FigurePanel error{
      .title = "Coordination error |x1 - x2|", .x_label = "time [s]", .y_label = "error [mrad]"};
  FigurePanel scatter{.title = "Coordination error against contact torque",
                      .x_label = "contact torque |f2| [N m]",
                      .y_label = "error |x1 - x2| [mrad]"};
  for (Run& run : runs) {
    Parameters p = lab.parameters;
    p.kind = run.kind;
    const std::string law = name(run.kind);
    run.session = lab.run({law, p, kSeconds,
                           "The " + law +
                               " coupling: press the tip onto the surface, hold it there, lift it "
                               "off. Repeat this at least three times within 20 s."});
    const Session& s = run.session;
    force.series.push_back(over_time(s, law, run.ink, Series::Style::line,
                                     [&](auto k) { return contact_torque(s, k); }));
    error.series.push_back(error_over_time(s, law, run.ink));
    add_contact_scatter(scatter, s, law, run.ink);
    outcome.checks.push_back(
        at_least("lasting contacts, " + law + " coupling", lasting_contacts(s), kContacts));
  }
  figure.panels = {force, error, scatter};
  const double standard = contact_slope(runs[0].session);
  outcome.checks.push_back(
      at_most("standard coupling: slope of the error divided by 1/k_vc, deviation from 1",
              std::abs(standard * lab.parameters.k_vc - 1), 0.2));
  outcome.checks.push_back(
      at_most("slope of the error, proposed coupling divided by standard coupling",
              contact_slope(runs[1].session) / standard, 0.2));
  return outcome;
}

Outcome live_inertia(LiveLaboratory& lab) {
  Parameters p = lab.parameters;
  p.kind = CouplingKind::proposed;
  const double least = analyze(lab.arm, rest_pose(lab.arm), p, std::nullopt).eta_min;
  const double b = device_damping(lab.arm, p).mean() + p.b_v + p.k_vc * p.tick / 2;
  const double etas[] = {1, std::max(0.6, kMargin * least), kLargest};
  Outcome outcome;
  outcome.figure.title = "What a hand feels of the arm, at three etas";
  outcome.figure.caption =
      "Free motion under the proposed coupling. Inertia and damping are found from the estimated "
      "hand torque, without the observer's lag, as its parts along M(x1) a1 and along v1. Both are "
      "divided by their values at eta = 1. Lines show equation (24) of the paper.";
  outcome.figure.columns = 2;
  FigurePanel torque{.title = "Estimate of the human torque |f1|",
                     .x_label = "time [s]",
                     .y_label = "torque [N m]"};
  FigurePanel share{.title = "Inertia and damping felt, divided by their values at eta = 1",
                    .x_label = "eta [-]",
                    .y_label = "share [-]"};
  Series inertia{"inertia", kProposedInk, Series::Style::points, {}};
  Series damping{"damping", kHandInk, Series::Style::points, {}};
  Felt at_one;
  for (std::size_t i = 0; i < std::size(etas); ++i) {
    p.eta = etas[i];
    const Session s = lab.run(swing(p));
    torque.series.push_back(
        over_time(s, fmt::format("eta = {:.2f}", p.eta), kFamilyInk[i], Series::Style::line,
                  [&](auto k) { return vector_at(s, k, Column::hand_torque_estimate).norm(); }));
    const Felt felt = felt_of(s, lab.arm);
    if (i == 0) at_one = felt;
    const double mass = felt.inertia / at_one.inertia;
    const double drag = felt.damping.mean() / at_one.damping.mean();
    inertia.points.push_back({p.eta, mass});
    damping.points.push_back({p.eta, drag});
    if (i == 0) {
      outcome.checks.push_back(at_least(
          "inertia felt at eta = 1, divided by the inertia of the model", felt.inertia, 0.5));
      continue;
    }
    outcome.checks.push_back(at_most(fmt::format("inertia felt at eta = {:.2f}, divided by the "
                                                 "inertia at eta = 1: deviation from equation (24)",
                                                 p.eta),
                                     std::abs(mass - promised_inertia(p, b)), kOff));
    outcome.checks.push_back(at_most(
        fmt::format(
            "damping felt at eta = {:.2f}, divided by the damping at eta = 1: deviation from eta",
            p.eta),
        std::abs(drag - p.eta), kOff));
  }
  Series of_inertia{"", kProposedInk, Series::Style::dashed, {}};
  Series of_damping{"", kHandInk, Series::Style::dashed, {}};
  for (p.eta = 0.4; p.eta <= 2; p.eta += 0.05) {
    of_inertia.points.push_back({p.eta, promised_inertia(p, b)});
    of_damping.points.push_back({p.eta, p.eta});
  }
  share.series = {inertia, damping, of_inertia, of_damping};
  outcome.figure.panels = {torque, share};
  return outcome;
}

Outcome live_passivity(LiveLaboratory& lab) {
  struct Law {
    CouplingKind kind;
    const char* ink;
  };
  constexpr Law kRuns[] = {{CouplingKind::standard, kStandardInk},
                           {CouplingKind::proposed, kProposedInk},
                           {CouplingKind::predictive, kPredictiveInk}};
  Outcome outcome;
  outcome.figure.title = "Energy that the coupling adds, in your hand";
  outcome.figure.caption =
      "Controller energy E_c in free motion, taps and circles on the surface. E_c may fall. Where "
      "E_c is above zero, the coupling has produced energy.";
  FigurePanel energy{.title = "Total", .x_label = "time [s]", .y_label = "energy [mJ]"};
  for (const Law& law : kRuns) {
    Parameters p = lab.parameters;
    p.kind = law.kind;
    const std::string label = name(law.kind);
    const Session s = lab.run({label, p, kPassivitySeconds,
                               "The " + label +
                                   " coupling: for 20 s, move freely, tap the surface, and draw "
                                   "circles on the surface."});
    double highest = 0;
    for (std::size_t k = 0; k < s.size(); ++k) {
      highest = worse(highest, s.at(k, Column::energy_total)[0]);
    }
    energy.series.push_back(over_time(s, label, law.ink, Series::Style::line, [&](auto k) {
      return 1e3 * s.at(k, Column::energy_total)[0];
    }));
    // A hand that touches nothing shows nothing.
    outcome.checks.push_back(
        at_least("lasting contacts, " + label + " coupling", lasting_contacts(s), 1));
    outcome.checks.push_back(
        at_most("highest E_c, " + label + " coupling [J]", highest, kHighestLive));
  }
  outcome.figure.panels = {energy};
  return outcome;
}

Outcome live_zwidth(LiveLaboratory& lab) {
  Outcome outcome;
  outcome.figure.title = "The stiffest wall that does not vibrate in your hand";
  outcome.figure.caption = fmt::format(
      "The hand taps and presses walls. The first wall has {} N/m, and each next wall is twice as "
      "stiff as the one before. The series ends when the rms speed of the tip above 20 Hz in "
      "contact exceeds {} mm/s.",
      kSoft, 1e3 * WellRendered::kChatter);
  FigurePanel panel{.title = "Chatter in contact",
                    .x_label = "stiffness of the wall [N/m]",
                    .y_label = "rms speed above 20 Hz [mm/s]",
                    .log_x = true};
  double stiffest[2] = {};
  constexpr CouplingKind kRuns[] = {CouplingKind::proposed, CouplingKind::predictive};
  constexpr const char* kInks[] = {kProposedInk, kPredictiveInk};
  for (std::size_t i = 0; i < 2; ++i) {
    Parameters p = lab.parameters;
    p.kind = kRuns[i];
    Series line{name(p.kind), kInks[i], Series::Style::line, {}};
    bool renders = true;
    for (double k = kSoft; renders && k <= kStiffest; k *= 2) {
      const Wall wall = tap(lab, p, k);
      renders = wall.renders;
      if (renders) stiffest[i] = k;
      line.points.push_back({k, 1e3 * wall.chatter});
    }
    panel.series.push_back(line);
  }
  outcome.figure.panels = {panel};
  outcome.checks = {at_least("stiffest wall, proposed coupling [N/m]", stiffest[0], kSoft),
                    at_least("stiffest wall, predictive coupling divided by proposed coupling",
                             stiffest[1] / std::max(kSoft, stiffest[0]), 1)};
  return outcome;
}

}  // namespace limpid
