// Contacts made and broken, and couplings switched while pressing: no energy is made, and the
// torque does not jump.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/experiments/signals.h"
#include "core/math/elementary.h"
#include "core/touch/wall_force.h"

namespace limpid {
namespace {

constexpr double kSwitchingTick = 0.001;
constexpr double kSwitchingAhead = 0.19,
                 kSwing = 0.006;   // place of the tip; sideways amplitude of the hand [m]
constexpr double kSwinging = 3.3;  // [Hz]
constexpr double kLasts = 2.5;     // [s]
// Stiffness [N m/rad]: one that both render, and one so stiff that contact is broken by its spring,
// not its damper.
constexpr double kStop = 20, kStiffStop = 500;
constexpr int kTurret = 0;
constexpr double kWallDamping = 0.2;  // the fine preset's, as a part of a joint's inertia a tick
constexpr double kSwitchingPress = 1, kSwitchingSurface = -0.04;  // [N], [m]
constexpr double kFirst = 0.8, kEvery = 0.3;                      // first switch; interval [s]
constexpr std::array kOrder{CouplingKind::standard,   CouplingKind::proposed,
                            CouplingKind::predictive, CouplingKind::proposed,
                            CouplingKind::standard,   CouplingKind::predictive};

std::string stop_scene(double stiffness) {
  return fmt::format(R"(title = "Stop"
about = "A stop of the first joint, flat in joint space."

[[joint_contact]]
name = "stop"
joint = "turret"
angle = 0.0
side = "above"
stiffness = {:.1f}
)",
                     stiffness);
}

// Trial that swings sideways into the stop and out of it, with ticks at ever other depths.
Trial swinging(const ExperimentArm& on, CouplingKind kind, double stop) {
  Parameters p = on.settings;
  p.kind = kind;
  const auto at = [](double t) {
    return Vec3(kSwitchingAhead, -kSwing * cosine(2 * std::numbers::pi * kSwinging * t), 0);
  };
  const std::string source = fmt::format("swinging {} m at {} Hz", kSwing, kSwinging);
  return {
      fmt::format("stop-{}-{}", stop, name(kind)),
      plan_in(on.description, stop_scene(stop), hand_path(source, kSwitchingTick, kLasts, at), p)};
}

// Trial that presses the table while couplings take turns: each follows each other once.
Trial pressing(const ExperimentArm& on) {
  Parameters p = on.settings;
  p.kind = CouplingKind::predictive;
  const double deep = kSwitchingPress / p.hand_stiffness + kSwitchingPress / 600;
  const auto at = [deep](double t) {
    return Vec3(0.2, 0, kSwitchingSurface + 0.01 - (0.01 + deep) * minimum_jerk(t / 0.5));
  };
  const double seconds = kFirst + kEvery * static_cast<double>(kOrder.size());
  Trial trial{"switching",
              plan_in(on.description, kTableScene,
                      hand_path("pressing the table", kSwitchingTick, seconds, at), p)};
  for (std::size_t i = 0; i < kOrder.size(); ++i) {
    const double t = kFirst + kEvery * static_cast<double>(i);
    trial.plan.changes.push_back({static_cast<std::uint64_t>(std::llround(t / kSwitchingTick)),
                                  fmt::format("coupling.kind = \"{}\"", name(kOrder[i]))});
  }
  return trial;
}

// Energy of the stop: given, still stored and taken by its damper; the sum must not be positive.
struct Balance {
  std::vector<double> gain;  // with the damper's share [J]
  int touched = 0;           // number of contacts
};

Balance balance_of(const Trial& trial, const Session& s) {
  const double damper = s.at(0, Column::kind)[0] == 2 ? kWallDamping : 0;
  Balance balance;
  const double K = trial.plan.document.scene.objects.front().material.stiffness;
  double taken = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    balance.gain.push_back(s.at(k, Column::contact_gain)[0] + taken);
    if (k + 1 == s.size()) break;
    const double d = s.at(k, Column::proxy_position)[kTurret];
    const double next = s.at(k + 1, Column::proxy_position)[kTurret];
    if (d <= 0 && next > 0) ++balance.touched;
    if (damper == 0 || (d <= 0 && next <= 0)) continue;
    // The damper acts for the share of the tick spent inside.
    const Eigen::MatrixXd M =
        (1 + trial.plan.parameters.inertia_ratio) *
        inertia_at(trial.plan.arm, vector_at(s, k, Column::measured_position));
    const double B = wall_damping(K, 1 / M.inverse()(kTurret, kTurret), kSwitchingTick, damper, 0);
    const double in = std::max(d, 0.0), in_next = std::max(next, 0.0);
    // A wall does not pull: where its damper would, the damper takes what the spring releases.
    const bool pushes = s.at(k, Column::contact_torque)[kTurret] != 0;
    taken += pushes ? B * (next - d) / kSwitchingTick * (in_next - in)
                    : K / 2 * (in * in - in_next * in_next);
  }
  return balance;
}

double furthest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = worse(most, std::abs(v));
  return most;
}

// Largest change of any joint's motor torque in a tick [N m]: during the change from one law's
// torque to the other's, and after it.
struct Steps {
  double on_the_way = 0, there = 0;
  int arrived = 0;  // number of changes completed
};

Steps steps_of(const Session& s) {
  Steps steps;
  bool there = true;
  for (auto k = static_cast<std::size_t>(std::llround(kFirst / kSwitchingTick)); k < s.size();
       ++k) {
    if (s.at(k, Column::kind)[0] != s.at(k - 1, Column::kind)[0]) there = false;
    const Eigen::VectorXd torque = vector_at(s, k, Column::motor_torque);
    const Eigen::VectorXd change = torque - vector_at(s, k - 1, Column::motor_torque);
    double& most = there ? steps.there : steps.on_the_way;
    most = worse(most, change.cwiseAbs().maxCoeff());
    const bool arrives = !there && torque == vector_at(s, k, Column::commanded_torque);
    steps.arrived += arrives;
    there = there || arrives;
  }
  return steps;
}

// Largest difference of the recorded energies from the sums of torques and motions [J].
double books_off(const Session& s) {
  double commanded = 0, most = 0;
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const auto moved = [&](Column c) -> Eigen::VectorXd {
      return vector_at(s, k + 1, c) - vector_at(s, k, c);
    };
    const Eigen::VectorXd dx2 = moved(Column::proxy_position);
    const Eigen::VectorXd tau2 = vector_at(s, k, Column::proxy_torque);
    commanded +=
        vector_at(s, k, Column::motor_torque).dot(moved(Column::device_position)) + tau2.dot(dx2);
    const double kinetic =
        s.at(k + 1, Column::proxy_kinetic)[0] - s.at(k, Column::proxy_kinetic)[0];
    const double given = (tau2 + vector_at(s, k, Column::contact_torque)).dot(dx2);
    most = worse(most, std::abs(kinetic - given));
    most = worse(most, std::abs(commanded - s.at(k + 1, Column::energy_commanded)[0]));
  }
  return most;
}

FigurePanel stop_panel(const Session& s) {
  FigurePanel panel{
      .title = fmt::format("A joint moves into its stop of {} N m/rad and out again", kStop),
      .x_label = "time [s]",
      .y_label = "angle beyond the stop [mrad]"};
  panel.series = {
      over_time(s, "device x1", kDeviceInk, Series::Style::line,
                [&](auto k) { return 1e3 * s.at(k, Column::device_position)[kTurret]; }),
      over_time(s, "proxy x2", kProxyInk, Series::Style::dashed,
                [&](auto k) { return 1e3 * s.at(k, Column::proxy_position)[kTurret]; })};
  panel.x_range = {0, kLasts};
  return panel;
}

FigurePanel gain_panel(const Session& paper, const Balance& papers, const Session& ours,
                       const Balance& own, const Balance& stiff) {
  FigurePanel panel{
      .title = "Energy that the stop created", .x_label = "time [s]", .y_label = "energy [μJ]"};
  const auto label = [](const char* law, double stop) {
    return fmt::format("{}, {} N m/rad", law, stop);
  };
  panel.series = {over_time(paper, label("proposed", kStop), kProposedInk, Series::Style::line,
                            [&](auto k) { return 1e6 * papers.gain[k]; }),
                  over_time(ours, label("predictive", kStop), kPredictiveInk, Series::Style::line,
                            [&](auto k) { return 1e6 * own.gain[k]; }),
                  over_time(ours, label("predictive", kStiffStop), kPredictiveTint,
                            Series::Style::dashed, [&](auto k) { return 1e6 * stiff.gain[k]; })};
  panel.x_range = {0, kLasts};
  return panel;
}

FigurePanel torque_panel(const Session& s) {
  FigurePanel panel{
      .title = "Motor torque while the couplings change and the hand presses the table",
      .x_label = "time [s]",
      .y_label = "torque [N m]"};
  constexpr const char* kNames[] = {"turret", "shoulder", "elbow"};
  for (std::size_t j = 0; j < 3; ++j) {
    panel.series.push_back(over_time(s, kNames[j], kFamilyInk[j], Series::Style::line,
                                     [&](auto k) { return s.at(k, Column::motor_torque)[j]; }));
  }
  for (std::size_t i = 0; i < kOrder.size(); ++i) {
    const double t = kFirst + kEvery * static_cast<double>(i);
    panel.series.push_back(
        {i == 0 ? "switched" : "", kNeutralInk, Series::Style::dashed, {{t, -0.3}, {t, 0.05}}});
  }
  panel.x_range = {0.6, s.at(s.size() - 1, Column::time)[0]};
  panel.y_range = {-0.3, 0.05};
  return panel;
}

FigurePanel apart_panel(const Session& s) {
  FigurePanel panel{.title = "Distance of device and proxy while the couplings change",
                    .x_label = "time [s]",
                    .y_label = "|x1 - x2| [mrad]"};
  for (const CouplingKind kind :
       {CouplingKind::standard, CouplingKind::proposed, CouplingKind::predictive}) {
    const auto number = static_cast<double>(kind);
    const char* ink = kind == CouplingKind::standard   ? kStandardInk
                      : kind == CouplingKind::proposed ? kProposedInk
                                                       : kPredictiveInk;
    Series dots{name(kind), ink, Series::Style::points, {}};
    for (std::size_t k = 0; k < s.size(); k += 2) {
      if (s.at(k, Column::kind)[0] != number) continue;
      dots.points.push_back({s.at(k, Column::time)[0], 1e3 * coordination_error(s, k).norm()});
    }
    panel.series.push_back(dots);
  }
  panel.x_range = {0.6, s.at(s.size() - 1, Column::time)[0]};
  return panel;
}

}  // namespace

Outcome switching(TrialRunner& lab) {
  const ExperimentArm& on = lab.arm();
  const std::vector<Trial> trials{swinging(on, CouplingKind::proposed, kStop),
                                  swinging(on, CouplingKind::predictive, kStop), pressing(on),
                                  swinging(on, CouplingKind::predictive, kStiffStop)};
  const std::vector<TrialResult> results = lab.run(trials);
  const Session &paper = results[0].session, &ours = results[1].session,
                &turns = results[2].session;
  const Balance papers = balance_of(trials[0], paper), own = balance_of(trials[1], ours),
                stiff = balance_of(trials[3], results[3].session);

  const Steps steps = steps_of(turns);

  Outcome outcome;
  outcome.figure.title = "Contacts made and broken, couplings switched";
  outcome.figure.caption = fmt::format(
      "Above: a hand of 300 N/m and 2 N s/m moves the first joint into an end stop and out again, "
      "at {} Hz. The stop is flat in joint space, so there is no curvature. The energy created is "
      "the sum of three: the work of the stop, the energy still stored in the stop, and the energy "
      "that the predictive coupling's damper took. Below: the hand presses a table of 600 N/m with "
      "{} N. Meanwhile Limpid switches from each of the three couplings to the other two. eta = 1.",
      kSwinging, kSwitchingPress);
  outcome.figure.columns = 2;
  outcome.figure.panels = {stop_panel(ours), gain_panel(paper, papers, ours, own, stiff),
                           torque_panel(turns), apart_panel(turns)};
  outcome.checks = {
      at_least("predictive: number of contacts made with each stop",
               std::min(own.touched, stiff.touched), 7),
      at_most("predictive: largest energy that is created when contact is made or broken [J]",
              worse(furthest(own.gain), furthest(stiff.gain)), 1e-9),
      at_least("proposed: largest energy that is created when contact is made or broken [J]",
               furthest(papers.gain), 1e-6),
      at_least("switching while pressing: completed transitions to another law", steps.arrived,
               kOrder.size() - 1),
      at_most("switching while pressing: largest change of a motor's torque in a tick during the "
              "transition to the other law [N m]",
              steps.on_the_way, 0.0065),
      at_most("switching while pressing: largest change of a motor's torque in a tick after the "
              "transition [N m]",
              steps.there, 0.05),
      at_most("switching while pressing: difference between the recorded energies and torques "
              "times motions [J]",
              books_off(turns), 1e-12)};
  return outcome;
}

}  // namespace limpid
