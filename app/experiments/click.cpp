// Click of a button: the force felt over its travel, against the button's own force.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/experiments/moving.h"
#include "app/experiments/staggered.h"
#include "core/math/elementary.h"

namespace limpid {
namespace {

constexpr double kClickForce = 0.5, kClickDetent = 0.4, kClickPeriod = 0.008;   // [N, N, m]
constexpr double kClickMass = 0.002;                                            // [kg]
constexpr double kClickTip = 0.004, kClickHeight = 0.006, kClickStop = 0.0096;  // [m]
constexpr double kClickTop = -0.007;                         // of the button at rest [m]
constexpr double kClickGrip = 3000;                          // [N/m]
constexpr double kClickTick = 0.001, kClickFastest = 0.035;  // [s, m/s]
constexpr double kClickAbove = 0.002, kClickDeep = 0.0125, kClickRest = 0.2;  // [m, m, s]
constexpr double kClickFrom = 2e-4;                 // least travel that is judged [m]
constexpr double kClickDamping = 2;                 // [N s/m]
constexpr double kClickHard[] = {600, 2000, 5000};  // [N/m]
constexpr double kClickUsual = 2000;

double given_force(double travel) {
  return kClickForce + kClickDetent * sine(2 * std::numbers::pi / kClickPeriod * travel);
}

std::string button(double stiffness) {
  return scene_of({{.name = "button",
                    .size = Vec3(0.012, 0.012, kClickHeight),
                    .mass = kClickMass,
                    .at = Vec3(0.18, 0, kClickTop - kClickHeight / 2),
                    .stiffness = stiffness,
                    .more = fmt::format("[body.joint]\nkind = \"slider\"\naxis = [0, 0, -1]\n"
                                        "limits = [0, {}]\ntravel = [[0, {}]]\n"
                                        "detent = {{ force = {}, period = {} }}\n",
                                        kClickStop, kClickForce, kClickDetent, kClickPeriod)}},
                  fmt::format("gravity = [0, 0, 0]\ntip_radius = {}\n", kClickTip));
}

// Path down, a rest, and up again, at most at kClickFastest.
HandPath pressing() {
  const double way = kClickAbove + kClickDeep, down = 1.875 * way / kClickFastest;
  return hand_path(
      fmt::format("presses a button by {} m at up to {} m/s", kClickDeep, kClickFastest),
      kClickTick, 2 * down + 3 * kClickRest, [=](double t) {
        const double in = minimum_jerk((t - kClickRest) / down) -
                          minimum_jerk((t - 2 * kClickRest - down) / down);
        return Vec3(0.18, 0, kClickAbove - way * in);
      });
}

Parameters in_a_stiff_hand(const ExperimentArm& on, CouplingKind kind) {
  Parameters p = on.settings;
  p.kind = kind;
  p.hand_stiffness = kClickGrip;
  return p;
}

// A press: travel and the hand's force, down and up.
struct Press {
  std::string label;
  const char* ink;
  std::vector<double> travel = {}, force = {};  // at each tick [m, N]
  double beyond = 0;                            // [J]

  // Rms of felt less given force where the button is pressed [N]; infinite if it diverged.
  double off() const {
    double sum = 0;
    int count = 0;
    for (std::size_t k = 0; k < travel.size(); ++k) {
      if (travel[k] < kClickFrom) continue;
      const double d = force[k] - given_force(travel[k]);
      sum += d * d;
      ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : HUGE_VAL;
  }
  double deepest() const { return travel.empty() ? 0 : *std::ranges::max_element(travel); }
  Series curve(Series::Style style) const {
    Series line{label, ink, style, {}};
    for (std::size_t k = 0; k < travel.size(); ++k) {
      if (travel[k] >= kClickFrom) line.points.push_back({1e3 * travel[k], force[k]});
    }
    return line;
  }
};

// Adds travel and force, both means over the same tick.
void add_ticks(Press& press, const TipRecord& record, const std::vector<double>& travel) {
  for (std::size_t k = 0; k + 1 < travel.size() && k < record.force.size(); ++k) {
    press.travel.push_back((travel[k] + travel[k + 1]) / 2);
    press.force.push_back(-record.force[k].z());
  }
}

Trial button_pressed(const ExperimentArm& on, CouplingKind kind, double stiffness) {
  Trial trial{fmt::format("{}-{}", name(kind), stiffness),
              plan_in(on.description, button(stiffness), pressing(), in_a_stiff_hand(on, kind))};
  trial.may_diverge = kind != CouplingKind::predictive;
  return trial;
}

Press press_of(const Trial& trial, const TrialResult& result, std::string label, const char* ink) {
  Press press{std::move(label), ink};
  press.beyond = judge_moving(result).beyond;
  if (result.end.diverged) return press;
  std::vector<double> travel;
  for (std::size_t k = 0; k < result.session.size(); ++k) {
    travel.push_back(kClickTop - kClickHeight / 2 - result.session.at(k, Column::body_pose)[2]);
  }
  add_ticks(press, tip_record(trial.plan.arm, result.session), travel);
  return press;
}

Press press_staggered(const ExperimentArm& on, double damping, double stiffness, const char* ink) {
  const auto own = [](double s) { return given_force(s); };
  const StaggeredRun run =
      run_staggered(on.description, in_a_stiff_hand(on, CouplingKind::predictive), pressing(),
                    {.mass = kClickMass,
                     .stiffness = stiffness,
                     .damping = damping,
                     .normal = Vec3(Vec3::UnitZ()),
                     .gap = kClickAbove - kClickTip - kClickTop,
                     .own = own,
                     .least_travel = 0});
  Press press{fmt::format("staggered, {} N s/m", damping), ink};
  press.beyond = run.most_beyond();
  if (!run.diverged) add_ticks(press, run.record, run.travel);
  return press;
}

FigurePanel click_panel(const std::string& title, const std::vector<Press>& presses,
                        Series::Style style) {
  FigurePanel panel{.title = title,
                    .x_label = "displacement [mm]",
                    .y_label = "force [N]",
                    .x_range = std::pair(0.0, 1e3 * kClickStop),
                    .y_range = std::pair(0.0, 1.2)};
  for (const Press& press : presses) panel.series.push_back(press.curve(style));
  Series line{"given", kNeutralInk, Series::Style::dashed, {}};
  for (double s = 0; s < kClickStop; s += kClickStop / 200)
    line.points.push_back({1e3 * s, given_force(s)});
  panel.series.push_back(line);
  return panel;
}

}  // namespace

Outcome click(TrialRunner& lab) {
  using enum CouplingKind;
  const ExperimentArm& on = lab.arm();
  std::vector<Trial> trials;
  for (const double K : kClickHard) trials.push_back(button_pressed(on, predictive, K));
  for (const CouplingKind kind : {proposed, standard})
    trials.push_back(button_pressed(on, kind, kClickUsual));
  const std::vector<TrialResult> results = lab.run(trials);
  std::vector<Press> ours, laws, usual, hard;
  for (std::size_t i = 0; i < std::size(kClickHard); ++i) {
    ours.push_back(
        press_of(trials[i], results[i], fmt::format("{} N/m", kClickHard[i]), kFamilyInk[i]));
  }
  laws = {press_of(trials[3], results[3], "proposed", kProposedInk),
          press_of(trials[4], results[4], "standard", kStandardInk)};
  usual = {press_staggered(on, 0, kClickUsual, kDeviceInk),
           press_staggered(on, kClickDamping, kClickUsual, kContactInk)};
  hard = {press_staggered(on, kClickDamping, kClickHard[2], kContactInk)};

  Outcome outcome;
  outcome.figure.title = "The click of a button: force felt, and force given by the button";
  outcome.figure.columns = 2;
  using enum Series::Style;
  outcome.figure.panels = {
      click_panel("Predictive, contacts of three stiffnesses", ours, line),
      click_panel(fmt::format("Other laws, contacts of {} N/m", kClickUsual), laws, points),
      click_panel(fmt::format("Staggered solution, contacts of {} N/m", kClickUsual), usual,
                  points),
      click_panel(fmt::format("Staggered solution, contacts of {} N/m", kClickHard[2]), hard,
                  points)};
  outcome.figure.caption = fmt::format(
      "A hand presses and releases a button of {} g without weight. The button pushes with {} + {} "
      "sin(2 pi s / {} mm) N at a displacement s. The highest speed is {} mm/s. The force felt is "
      "the hand's own force. It contains the force of the device's damping, so it is larger on the "
      "way down and smaller on the way up. The other laws compute the button's motion after the "
      "tick. Staggered means no coupling: the force of a tick is computed from the last positions "
      "of tip and button. Each dot is a tick.",
      1e3 * kClickMass, kClickForce, kClickDetent, 1e3 * kClickPeriod, 1e3 * kClickFastest);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const std::string which = fmt::format("predictive, {} N/m: ", kClickHard[i]);
    outcome.checks.push_back(
        at_most(which + "rms difference between the force felt and the force given [N]",
                ours[i].off(), 0.03));
    outcome.checks.push_back(at_most(
        which + "largest energy given to the human minus the energy that the button gave [J]",
        ours[i].beyond, 5e-5));
    outcome.checks.push_back(
        at_least(which + "largest displacement of the button [m]", ours[i].deepest(), 0.008));
  }
  return outcome;
}

}  // namespace limpid
