// Transparency of the couplings: inertia felt in free motion, stiffness felt in contact.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "app/experiments/experiment.h"
#include "app/experiments/felt_impedance.h"
#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "core/coupling/felt.h"

namespace limpid {

struct FeltSetting {
  CouplingKind kind = CouplingKind::proposed;
  double eta = 1;
  double wall = 0;  // beside the tip [N/m], 0: free space
};

// A bench in which only the first joint turns, so that everything is scalar.
class SidewaysBench {
 public:
  static constexpr int kJoint = 0;
  static constexpr double kArm = 0.19;                    // of the tip about its axis [m]
  static constexpr double kTick = 0.001;                  // [s]
  static constexpr double kPeriod = 2, kSettle = 2;       // of the shaking [s]
  static constexpr double kLowest = 0.5, kHighest = 200;  // [Hz]
  static constexpr double kSpeed = 2e-3;                  // at each frequency [m/s]
  // Grip: soft, and undamped in free space, where a damper would answer to the steps in the
  // target's rate from tick to tick. At a wall the hand must damp, or the proposed coupling is
  // unstable.
  static constexpr double kGrip = 100;       // [N/m]
  static constexpr double kGripDamping = 2;  // [N s/m]
  static constexpr double kPress = 1;        // mean force at a wall [N]

  SidewaysBench(const ExperimentArm& on, std::uint64_t seed)
      : on_(on),
        seed_(seed),
        shaking_(multisine(1 / kPeriod, kLowest, kHighest, 40, kSpeed, seed)) {}

  const ExperimentArm& on() const { return on_; }
  const Multisine& shaking() const { return shaking_; }
  // Trial of shaking; rows from settled() on last one period of it, and one row more.
  Trial shaken(const FeltSetting& setting) const;
  static std::size_t settled();
  // Trial that presses the wall and stays.
  Trial pressed(const FeltSetting& setting) const;

 private:
  const ExperimentArm& on_;
  std::uint64_t seed_;
  Multisine shaking_;
};

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

// Depth of the hand's target in the wall [m].
double aim(double wall) {
  return wall > 0 ? SidewaysBench::kPress * (1 / SidewaysBench::kGrip + 1 / wall) : 0;
}

Trial trial(const ExperimentArm& on, const FeltSetting& setting, const std::string& source,
            double seconds, const std::function<Vec3(double)>& at) {
  Parameters p = on.settings;
  p.kind = setting.kind;
  p.eta = setting.eta;
  p.tick = SidewaysBench::kTick;
  p.hand_stiffness = SidewaysBench::kGrip;
  p.hand_damping = setting.wall > 0 ? SidewaysBench::kGripDamping : 0;
  return {fmt::format("{}-eta-{}-wall-{}", name(p.kind), p.eta, setting.wall),
          plan_in(on.description, world(setting.wall),
                  hand_path(source, SidewaysBench::kTick, seconds, at), p)};
}

using Bench = SidewaysBench;
using Setting = FeltSetting;

constexpr double kPaperWall = 600;  // of the paper [N/m]
constexpr double kEtas[] = {0.4, 0.6, 1, 2, 5};
constexpr double kInContact[] = {0.6, 1, 2};
constexpr double kWalls[] = {50, 100, 200, 300, 400, 600, 800, 1000};  // [N/m]

std::string label(const Setting& s) {
  return s.kind == CouplingKind::standard ? "standard" : fmt::format("eta = {}", s.eta);
}

// The joint that the hand turns, without a contact.
FeltJoint free_joint(const RunPlan& plan) {
  const Eigen::VectorXd x = rest_at(plan.arm, plan.hand.position.front()).x1;
  const double m = inertia_at(plan.arm, x)(Bench::kJoint, Bench::kJoint);
  const Parameters& p = plan.parameters;
  return {(1 + p.inertia_ratio) * m,
          device_damping(plan.arm, p)[Bench::kJoint],
          p.b_v,
          p.k_vc,
          p.b_vc,
          p.tick,
          0};
}

FeltJoint touching(FeltJoint joint, double wall) {
  joint.K = wall * Bench::kArm * Bench::kArm;
  return joint;
}

// `alpha`: gain of the observer [N m s/rad].
std::complex<double> theory(const FeltJoint& joint, const Setting& s, double alpha, double f) {
  return s.kind == CouplingKind::standard ? joint.standard(f)
                                          : joint.proposed(f, s.eta, alpha / joint.m);
}

double off(std::complex<double> value, std::complex<double> wanted) {
  return std::abs(value - wanted) / std::abs(wanted);
}

// Largest distance of the measured impedance from `wanted` between two frequencies; infinite if
// nothing was measured there.
template <class Wanted>
double furthest(const Impedance& felt, double from, double to, const Wanted& wanted) {
  double worst = 0;
  int measured = 0;
  for (std::size_t i = 0; i < felt.f.size(); ++i) {
    if (felt.f[i] < from || felt.f[i] > to) continue;
    worst = worse(worst, wanted(felt.f[i], felt.Z[i]));
    ++measured;
  }
  return measured > 0 ? worst : std::numeric_limits<double>::infinity();
}

struct Felt {
  double alpha;  // gain of the observer [N m s/rad]
  std::vector<Setting> settings;
  std::vector<FeltJoint> joints;
  std::vector<Impedance> seen;
};

Felt shake(TrialRunner& lab, const Bench& bench, const std::vector<Setting>& settings) {
  std::vector<Trial> trials;
  for (const Setting& s : settings) trials.push_back(bench.shaken(s));
  const std::vector<TrialResult> results = lab.run(trials);
  Felt felt{bench.on().settings.alpha, settings, {}, {}};
  for (std::size_t i = 0; i < trials.size(); ++i) {
    felt.joints.push_back(touching(free_joint(trials[i].plan), settings[i].wall));
    felt.seen.push_back(
        measured_impedance(results[i].session, Bench::settled(), Bench::kJoint, bench.shaking()));
  }
  return felt;
}

FigurePanel impedance_panel(const Felt& felt, const std::string& title) {
  FigurePanel panel;
  panel.title = title;
  panel.x_label = "frequency [Hz]";
  panel.y_label = "|f1 / v1| [N m s/rad]";
  panel.log_x = panel.log_y = true;
  for (std::size_t i = 0; i < felt.seen.size(); ++i) {
    const Setting& s = felt.settings[i];
    const char* ink = s.kind == CouplingKind::standard ? kStandardInk : kFamilyInk[i - 1];
    Series points{label(s), ink, Series::Style::points, {}};
    Series line{"", ink, Series::Style::line, {}};
    for (std::size_t k = 0; k < felt.seen[i].f.size(); ++k) {
      const double f = felt.seen[i].f[k];
      points.points.push_back({f, std::abs(felt.seen[i].Z[k])});
      line.points.push_back({f, std::abs(theory(felt.joints[i], s, felt.alpha, f))});
    }
    panel.series.push_back(line);
    panel.series.push_back(points);
  }
  return panel;
}

double worst_off_theory(const Felt& felt, double to) {
  double worst = 0;
  for (std::size_t i = 0; i < felt.seen.size(); ++i) {
    worst = worse(worst, furthest(felt.seen[i], Bench::kLowest, to, [&](double f, auto Z) {
                    return off(Z, theory(felt.joints[i], felt.settings[i], felt.alpha, f));
                  }));
  }
  return worst;
}

// Curve of |Z| over |Z| at eta = 1 against eta, at one frequency.
Series scaling_line(const FeltJoint& joint, double w_f, double f, const char* ink) {
  Series line{"", ink, Series::Style::line, {}};
  for (double eta = 0.3; eta < 7; eta *= 1.05) {
    const double ratio = std::abs(joint.proposed(f, eta, w_f) / joint.proposed(f, 1, w_f));
    line.points.push_back({eta, ratio});
  }
  return line;
}

FigurePanel scaling_panel(const Felt& felt, std::size_t at_one, double w_f) {
  FigurePanel panel;
  panel.title = "Impedance in free motion / impedance at eta = 1 (lines: theory)";
  panel.x_label = "eta [-]";
  panel.y_label = "|Z(eta)| / |Z(1)| [-]";
  panel.log_x = panel.log_y = true;
  panel.series.push_back({"eta", kNeutralInk, Series::Style::dashed, {{0.3, 0.3}, {7, 7}}});
  const Impedance& reference = felt.seen[at_one];
  std::size_t ink = 0;
  for (const double wanted : {0.5, 3.0, 10.0, 50.0}) {
    const auto found = std::ranges::lower_bound(reference.f, wanted);
    const auto k = static_cast<std::size_t>(found - reference.f.begin());
    const char* color = kFamilyInk[ink++];
    Series points{fmt::format("{:.3g} Hz", *found), color, Series::Style::points, {}};
    for (std::size_t i = 1; i < felt.seen.size(); ++i) {
      points.points.push_back({felt.settings[i].eta, std::abs(felt.seen[i].Z[k] / reference.Z[k])});
    }
    panel.series.push_back(scaling_line(felt.joints.front(), w_f, *found, color));
    panel.series.push_back(points);
  }
  return panel;
}

void free_motion(TrialRunner& lab, const Bench& bench, Outcome& outcome) {
  std::vector<Setting> settings{{CouplingKind::standard, 1, 0}};
  for (const double eta : kEtas) settings.push_back({CouplingKind::proposed, eta, 0});
  const Felt felt = shake(lab, bench, settings);
  const FeltJoint& joint = felt.joints.front();
  const double w_f = felt.alpha / joint.m;
  outcome.figure.panels.push_back(
      impedance_panel(felt, "Impedance felt in free motion (lines: theory)"));
  outcome.figure.panels.push_back(scaling_panel(felt, 3, w_f));

  double off_ideal = 0, off_inertia = 0, off_low = 0;
  for (std::size_t i = 1; i < felt.seen.size(); ++i) {
    const double eta = felt.settings[i].eta;
    const auto off_size = [&](double f, std::complex<double> Z) {
      return std::abs(std::abs(Z / joint.ideal(f, eta)) - 1);
    };
    off_low = worse(off_low, furthest(felt.seen[i], 0, 1, off_size));
    if (eta > 1) continue;
    off_ideal = worse(off_ideal, furthest(felt.seen[i], 5, 15, off_size));
    Impedance expected{felt.seen[i].f, {}};
    for (const double f : expected.f) expected.Z.push_back(joint.proposed(f, eta, w_f));
    const double inertia_seen = apparent_inertia(felt.seen[i], 3);
    off_inertia = worse(off_inertia, std::abs(inertia_seen / apparent_inertia(expected, 3) - 1));
  }
  outcome.checks.push_back(
      at_most("free motion: deviation of the impedance from equation (24) in ticks, 0.5 to 50 Hz, "
              "all couplings",
              worst_off_theory(felt, 50), 0.10));
  outcome.checks.push_back(
      at_most("free motion: deviation of |Z| from |eta (M_L j w + b)|, 0.5 to 1 Hz, eta 0.4 to 5",
              off_low, 0.10));
  outcome.checks.push_back(
      at_most("free motion: deviation of |Z| from |eta (M_L j w + b)|, 5 to 15 Hz, eta 0.4 to 1",
              off_ideal, 0.15));
  outcome.checks.push_back(
      at_most("free motion: deviation of the inertia Im Z / w from the inertia of equation (24) in "
              "ticks, up to 3 Hz, eta 0.4 to 1",
              off_inertia, 0.10));
}

void in_contact(TrialRunner& lab, const Bench& bench, Outcome& outcome) {
  std::vector<Setting> settings{{CouplingKind::standard, 1, kPaperWall}};
  for (const double eta : kInContact) settings.push_back({CouplingKind::proposed, eta, kPaperWall});
  const Felt felt = shake(lab, bench, settings);
  FigurePanel panel = impedance_panel(
      felt, fmt::format("Impedance felt at a wall of {} N/m (lines: theory)", kPaperWall));
  Series wall{"the wall alone", kContactInk, Series::Style::dashed, {}};
  for (const double f : felt.seen.front().f) {
    const double w = 2 * std::numbers::pi * f;
    if (f < 50) wall.points.push_back({f, felt.joints.front().K / w});
  }
  panel.series.push_back(wall);
  outcome.figure.panels.push_back(panel);
  outcome.checks.push_back(
      at_most("contact: deviation of the impedance from theory, 0.5 to 20 Hz, all couplings",
              worst_off_theory(felt, 20), 0.10));
}

void stiffness(TrialRunner& lab, const Bench& bench, Outcome& outcome) {
  constexpr CouplingKind kKinds[] = {CouplingKind::standard, CouplingKind::proposed};
  std::vector<Trial> trials;
  for (const CouplingKind kind : kKinds) {
    for (const double wall : kWalls) trials.push_back(bench.pressed({kind, 1, wall}));
  }
  std::vector<double> felt(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    const Session& s = result.session;
    const std::size_t last = s.size() - 1;
    const double turned = s.at(last, Column::device_position)[Bench::kJoint] -
                          s.at(0, Column::device_position)[Bench::kJoint];
    felt[i] = s.at(last, Column::hand_torque)[Bench::kJoint] / turned / (Bench::kArm * Bench::kArm);
  });
  const double in_series = bench.on().settings.k_vc / (Bench::kArm * Bench::kArm);  // [N/m]

  FigurePanel panel;
  panel.title = "Stiffness felt when pressing a wall";
  panel.x_label = "stiffness of the wall [N/m]";
  panel.y_label = "stiffness felt [N/m]";
  panel.log_x = panel.log_y = true;
  Series same{"as set", kNeutralInk, Series::Style::dashed, {}};
  Series soft{"wall in series with k_vc", kContactInk, Series::Style::line, {}};
  Series points[] = {{"standard", kStandardInk, Series::Style::points, {}},
                     {"proposed", kProposedInk, Series::Style::points, {}}};
  double off_series = 0, off_wall = 0;
  const std::size_t walls = std::size(kWalls);
  for (std::size_t i = 0; i < walls; ++i) {
    const double K = kWalls[i], expected = 1 / (1 / K + 1 / in_series);
    same.points.push_back({K, K});
    soft.points.push_back({K, expected});
    points[0].points.push_back({K, felt[i]});
    points[1].points.push_back({K, felt[walls + i]});
    off_series = worse(off_series, std::abs(felt[i] / expected - 1));
    off_wall = worse(off_wall, std::abs(felt[walls + i] / K - 1));
  }
  panel.series = {same, soft, points[0], points[1]};
  outcome.figure.panels.push_back(panel);
  outcome.checks.push_back(
      at_most("standard: deviation of the stiffness felt from 1 / (1/K + r^2/k_vc), walls of 50 to "
              "1000 N/m",
              off_series, 0.02));
  outcome.checks.push_back(
      at_most("proposed: deviation of the stiffness felt from the wall's stiffness, walls of 50 to "
              "1000 N/m",
              off_wall, 0.03));
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
  return trial(on_, setting, source, kSettle + kPeriod + kTick, at);
}

Trial SidewaysBench::pressed(const FeltSetting& setting) const {
  const double press = aim(setting.wall);
  const auto at = [&](double t) { return Vec3(kArm, -press * minimum_jerk(t / 0.5), 0); };
  Trial press_only = trial(on_, setting, fmt::format("pressing {:.4g} m", press), 1.5, at);
  press_only.keep = false;
  return press_only;
}

Outcome transparency(TrialRunner& lab) {
  const Bench bench(lab.arm(), lab.seed());
  Outcome outcome;
  outcome.figure.title = "Transparency: what the hand feels";
  outcome.figure.caption = fmt::format(
      "{} at the {}. The tip is {} m ahead and moves sideways, so that only the first joint turns. "
      "The impedance is the human torque divided by the velocity of that joint. The hand shakes "
      "with all frequencies from {} to {} Hz together in an undamped grip of {} N/m; in contact "
      "the hand presses with {} N and damps with {} N s/m. Without that damper the proposed "
      "coupling is unstable at this wall: its contact torque is delayed by b_v/k_vc + T/2, which "
      "needs more damping than there is.",
      lab.arm().heading(), lab.arm().gains(), Bench::kArm, Bench::kLowest, Bench::kHighest,
      Bench::kGrip, Bench::kPress, Bench::kGripDamping);
  outcome.figure.columns = 2;
  free_motion(lab, bench, outcome);
  in_contact(lab, bench, outcome);
  stiffness(lab, bench, outcome);
  return outcome;
}

}  // namespace limpid
