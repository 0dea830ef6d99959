// A device whose torque answers its reading late: energy given to the hand under the predictive
// coupling, and what is felt, free and at the walls that `limpid analyze` computes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "app/experiments/felt_impedance.h"
#include "app/experiments/signals.h"
#include "app/experiments/tap_bench.h"
#include "app/run/analysis.h"
#include "core/coupling/inertia_network.h"

namespace limpid {
namespace {

// Values varied, and bounds promised.
struct DelayPlan {
  static constexpr double kEtas[] = {0.1, 0.2, 0.5, 1, 2, 3.5, 5};
  static constexpr int kMost = 3;                             // ticks
  static constexpr double kGrips[] = {100, 300, 1000, 3000};  // [N/m]
  static constexpr double kPress = 2;                         // within the arm's own motors [N]
  static constexpr double kSettle = 1, kPeriod = 2;           // of the shaking [s]
  static constexpr double kAmplitude = 2.5e-4;                // at 1 Hz [m]
  static constexpr double kInertiaTo = 1;                     // [Hz]
  static constexpr double kGiven = 5e-3, kOff = 0.05;         // [J]; of the value wanted [-]
  // kOff of an inertia under a known delay: velocities are predicted too late for it.
  static constexpr double kOffKnown = 0.15;
  static constexpr double kSoftestNamed = 100;  // [N/m]
};

// A delay, and whether the law knows it.
struct Late {
  int ticks;
  bool known;

  std::string label() const {
    if (ticks == 0) return "none";
    return fmt::format("{} ms{}", ticks, known ? "" : ", not known");
  }
  const char* ink() const {
    constexpr const char* kInks[] = {kNeutralInk, kProxyInk, kDeviceInk, kContactInk};
    return kInks[ticks];
  }
  Series::Style style() const { return known ? Series::Style::line : Series::Style::dashed; }
};

std::vector<Late> all_delays() {
  std::vector<Late> all{{0, true}};
  for (const bool known : {true, false}) {
    for (int ticks = 1; ticks <= DelayPlan::kMost; ++ticks) all.push_back({ticks, known});
  }
  return all;
}

TapSetting late_setting(const Late& late, double eta) {
  return {.eta = eta,
          .press = DelayPlan::kPress,
          .own_motors = true,
          .delay = static_cast<double>(late.ticks),
          .knows_delay = late.known};
}

Multisine slow_shaking() {
  Multisine signal{1 / DelayPlan::kPeriod, {}};
  for (const auto& [multiple, phase] : {std::pair(1, 0.0), {2, 1.1}, {6, 0.7}, {14, 1.9}}) {
    signal.lines.push_back(
        {multiple, DelayPlan::kAmplitude * DelayPlan::kPeriod / multiple, phase});
  }
  return signal;
}

Trial free_trial(const ExperimentArm& on, const Late& late, double eta, double grip) {
  Parameters p =
      TapBench(on, late_setting(late, eta), DelayPlan::kSoftestNamed, grip, 1).parameters();
  const Vec3 along = Vec3(1, 0.8, 0.6).normalized();
  const auto at = [signal = slow_shaking(), along](double t) {
    return Vec3(kHome + minimum_jerk(t / 0.5) * signal.at(t) * along);
  };
  const double seconds = DelayPlan::kSettle + DelayPlan::kPeriod + p.tick;
  Trial trial{
      "", plan_in(on.description, kFreeSpace, hand_path("shaking slowly", p.tick, seconds, at), p)};
  trial.keep = false;
  return trial;
}

// Worst values over all grips for one delay at one eta.
struct LateFelt {
  double free = 0;     // most that the hand was given in free motion [J]
  double wall = 0;     // the same at the wall [J]
  double inertia = 0;  // felt inertia off the wanted one, where furthest, over max(eta, 1) [-]
  double felt = 1;     // felt stiffness over the one set, where furthest from 1 [-]
  double named = 0;    // wall named by `limpid analyze` [N/m]

  // Keeps the value furthest from `wanted`, or NaN.
  static void further(double& kept, double value, double wanted) {
    if (!(std::abs(value - wanted) <= std::abs(kept - wanted))) kept = value;
  }
};

using LateTable = std::vector<std::vector<LateFelt>>;  // of each delay and eta

// Runs `trial_of(on, late, eta, grip)` for all of them, and passes each result to `take`.
template <class TrialOf, class Take>
void for_all(TrialRunner& lab, const TrialOf& trial_of, const Take& take) {
  struct Place {
    std::size_t late, eta;
    double grip;
  };
  const std::vector<Late> delays = all_delays();
  std::vector<Place> places;
  std::vector<Trial> trials;
  for (std::size_t d = 0; d < delays.size(); ++d) {
    for (std::size_t e = 0; e < std::size(DelayPlan::kEtas); ++e) {
      for (const double grip : DelayPlan::kGrips) {
        places.push_back({d, e, grip});
        trials.push_back(trial_of(lab.arm(), delays[d], DelayPlan::kEtas[e], grip));
      }
    }
  }
  std::vector<std::function<void()>> found(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& result) {
    found[i] = take(places[i].late, places[i].eta, places[i].grip, trials[i], result);
  });
  for (const auto& each : found) each();  // in their order, whoever was first
}

double highest_port(const Session& s) {
  double most = 0;
  for (std::size_t k = 0; k < s.size(); ++k) most = worse(most, s.at(k, Column::energy_port)[0]);
  return most;
}

// Felt inertia by theory, over the arm's own. The torque of networks and, if the delay is not
// known, of dampers comes late, as in `limpid analyze`.
double wanted_inertia(const Late& late, const FeltMotion& felt, const RunPlan& plan) {
  const Parameters& p = plan.parameters;
  const double w = 2 * std::numbers::pi * felt.f, t_d = late.ticks * p.tick;
  const AddedMass added = added_mass(p.eta, most_delay(p, {}, false), p.tick, p.inertia_ratio);
  const std::complex<double> networks =
      network_impedance(added, p.band, w) * std::polar(1.0, -w * t_d);
  // Damping that motors give besides the networks [N s/m].
  const double by_motors =
      felt.damping - device_damping(plan.arm, p)[0] - felt.mass * networks.real();
  return 1 + networks.imag() / w - (late.known ? 0 : by_motors * t_d / felt.mass);
}

void free_motion(TrialRunner& lab, LateTable& table) {
  const std::vector<Late> delays = all_delays();
  const Trial one = free_trial(lab.arm(), {0, true}, 1, DelayPlan::kGrips[0]);
  const Eigen::MatrixXd M = (1 + one.plan.parameters.inertia_ratio) *
                            inertia_at(one.plan.arm, rest_at(one.plan.arm, kHome).x1);
  const auto settled =
      static_cast<std::size_t>(std::llround(DelayPlan::kSettle / one.plan.parameters.tick));
  for_all(lab, free_trial,
          [&](std::size_t d, std::size_t e, double, const Trial& trial, const TrialResult& r) {
            const double eta = DelayPlan::kEtas[e];
            double inertia = r.end.diverged ? HUGE_VAL : 0;
            if (!r.end.diverged) {
              for (const FeltMotion& m : measured_motion(r.session, settled, M, slow_shaking())) {
                if (m.f > DelayPlan::kInertiaTo) continue;
                const double wanted = wanted_inertia(delays[d], m, trial.plan);
                LateFelt::further(inertia, (m.inertia - wanted) / std::max(1.0, eta), 0);
              }
            }
            return [&table, d, e, inertia, port = highest_port(r.session)] {
              LateFelt& found = table[d][e];
              found.free = worse(found.free, port);
              LateFelt::further(found.inertia, inertia, 0);
            };
          });
}

void at_walls(TrialRunner& lab, LateTable& table) {
  const ExperimentArm& on = lab.arm();
  const auto bench = [&on](const Late& late, double eta, double grip) {
    const TapSetting s = late_setting(late, eta);
    return TapBench(on, s, named_wall(on, s), grip, 1);
  };
  const std::vector<Late> delays = all_delays();
  for_all(
      lab,
      [&](const ExperimentArm&, const Late& late, double eta, double grip) {
        return bench(late, eta, grip).trial();
      },
      [&](std::size_t d, std::size_t e, double grip, const Trial&, const TrialResult& r) {
        const double eta = DelayPlan::kEtas[e];
        const Touch touch = bench(delays[d], eta, grip).touch(r);
        return [&table, d, e, touch, port = highest_port(r.session),
                named = named_wall(on, late_setting(delays[d], eta))] {
          LateFelt& found = table[d][e];
          found.wall = worse(found.wall, port);
          found.named = named;
          LateFelt::further(found.felt, touch.felt, 1);
        };
      });
}

// A curve over eta for each delay; values beyond the frame are drawn at its edge.
template <class Value>
FigurePanel against_etas(const LateTable& table, const std::string& title, const std::string& y,
                         std::pair<double, double> range, const Value& value) {
  FigurePanel panel{.title = title, .x_label = "eta [-]", .y_label = y, .log_x = true};
  panel.x_range = {0.09, 5.6};
  panel.y_range = range;
  const std::vector<Late> delays = all_delays();
  for (std::size_t d = 0; d < delays.size(); ++d) {
    Series line{delays[d].label(), delays[d].ink(), delays[d].style(), {}};
    for (std::size_t e = 0; e < std::size(DelayPlan::kEtas); ++e) {
      const double found = value(table[d][e]);
      const double drawn = std::isnan(found) ? range.second : found;
      line.points.push_back({DelayPlan::kEtas[e], std::clamp(drawn, range.first, range.second)});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", delays[d].ink(), Series::Style::points, line.points});
  }
  return panel;
}

void add_bound(FigurePanel& panel, double value, const std::string& label) {
  panel.series.push_back({label, kHandInk, Series::Style::dashed, {{0.09, value}, {5.6, value}}});
}

FigurePanel named_panel(const LateTable& table) {
  FigurePanel panel{.title = "The wall that `limpid analyze` computes",
                    .x_label = "delay of the device [ms]",
                    .y_label = "stiffness [N/m]",
                    .log_y = true};
  panel.x_range = {-0.1, DelayPlan::kMost + 0.1};
  panel.y_range = {100, 30000};
  const std::vector<Late> delays = all_delays();
  for (const bool known : {true, false}) {
    Series line{known ? "known" : "not known",
                known ? kPredictiveInk : kEnergyInk,
                known ? Series::Style::line : Series::Style::dashed,
                {}};
    for (std::size_t d = 0; d < delays.size(); ++d) {
      if (delays[d].ticks > 0 && delays[d].known != known) continue;
      line.points.push_back(
          {static_cast<double>(delays[d].ticks), std::max(100.0, table[d][0].named)});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", line.color, Series::Style::points, line.points});
  }
  return panel;
}

std::vector<FigurePanel> draw(const LateTable& table) {
  constexpr std::pair kEnergies(1e-3, 1e5);  // [mJ]
  FigurePanel free = against_etas(table, "Free motion: largest energy given to the hand",
                                  "energy [mJ]", kEnergies, [](auto& f) { return 1e3 * f.free; });
  FigurePanel wall =
      against_etas(table, "Wall by `limpid analyze`: largest energy given to the hand",
                   "energy [mJ]", kEnergies, [](auto& f) { return 1e3 * f.wall; });
  for (FigurePanel* panel : {&free, &wall}) {
    panel->log_y = true;
    add_bound(*panel, 1e3 * DelayPlan::kGiven, "bound");
  }
  FigurePanel inertia = against_etas(
      table,
      fmt::format("Inertia felt up to {} Hz: deviation from the wanted inertia",
                  DelayPlan::kInertiaTo),
      "deviation / larger of eta and 1 [-]", {-0.5, 0.5}, [](auto& f) { return f.inertia; });
  FigurePanel felt = against_etas(table, "Stiffness felt at the wall, divided by the stiffness set",
                                  "felt / set [-]", {0, 1.5}, [](auto& f) { return f.felt; });
  for (const auto& [panel, wanted] : {std::pair(&inertia, 0.0), {&felt, 1.0}}) {
    add_bound(*panel, wanted + DelayPlan::kOff, "bounds");
    add_bound(*panel, wanted - DelayPlan::kOff, "");
  }
  return {free, wall, inertia, felt, named_panel(table)};
}

void judge(const LateTable& table, std::vector<Check>& checks) {
  const std::vector<Late> delays = all_delays();
  for (const bool known : {true, false}) {
    LateFelt worst{.named = HUGE_VAL};
    for (std::size_t d = 0; d < delays.size(); ++d) {
      if (delays[d].known != known) continue;
      for (const LateFelt& f : table[d]) {
        worst.free = worse(worst.free, f.free);
        worst.wall = worse(worst.wall, f.wall);
        worst.named = worse_low(worst.named, f.named);
        LateFelt::further(worst.inertia, f.inertia, 0);
        LateFelt::further(worst.felt, f.felt, 1);
      }
    }
    const std::string where = fmt::format("delay of {} to {} ms, {}: ", known ? 0 : 1,
                                          DelayPlan::kMost, known ? "known" : "not known");
    using P = DelayPlan;
    checks.push_back(at_most(where + "largest energy given to the human in free motion [J]",
                             worst.free, P::kGiven));
    checks.push_back(at_most(
        where + fmt::format("deviation of the inertia felt up to {} Hz from the inertia that "
                            "`limpid analyze` computes, divided by the larger of eta and 1",
                            P::kInertiaTo),
        std::abs(worst.inertia), known ? P::kOffKnown : P::kOff));
    checks.push_back(at_least(where + "softest wall that `limpid analyze` computes [N/m]",
                              worst.named, P::kSoftestNamed));
    checks.push_back(at_most(
        where + "largest energy given to the human at the wall that `limpid analyze` computes [J]",
        worst.wall, P::kGiven));
    checks.push_back(at_most(
        where + "relative deviation of the stiffness felt at that wall from the stiffness set",
        std::abs(worst.felt - 1), P::kOff));
  }
}

}  // namespace

Outcome delay(TrialRunner& lab) {
  LateTable table(all_delays().size(), std::vector<LateFelt>(std::size(DelayPlan::kEtas)));
  free_motion(lab, table);
  at_walls(lab, table);
  Outcome outcome;
  outcome.figure.title = "A device whose torque follows its reading with a delay";
  outcome.figure.caption = fmt::format(
      "Predictive coupling, eta {} to {}. The torque follows the reading with a delay of 0 to {} "
      "ms. The law knows this delay (model.delay) or does not know it. Grips are {} to {} N/m with "
      "{} N s/m; the worst grip is drawn. Free motion: the tip is shaken at all frequencies from "
      "0.5 to 7 Hz together, {} mm at 1 Hz. The inertia felt is compared with the inertia that "
      "`limpid analyze` computes: eta times the arm's own inertia, minus the part that delayed "
      "networks remove. If the delay is not known, delayed dampers remove a part too. At walls the "
      "tip taps at {} m/s and presses with {} N. Points outside a frame are drawn at the frame's "
      "edge.",
      DelayPlan::kEtas[0], DelayPlan::kEtas[std::size(DelayPlan::kEtas) - 1], DelayPlan::kMost,
      DelayPlan::kGrips[0], DelayPlan::kGrips[std::size(DelayPlan::kGrips) - 1],
      TapBench::kGripDamping, 1e3 * DelayPlan::kAmplitude, TapBench::kSpeed, DelayPlan::kPress);
  outcome.figure.columns = 2;
  outcome.figure.panels = draw(table);
  judge(table, outcome.checks);
  return outcome;
}

}  // namespace limpid
