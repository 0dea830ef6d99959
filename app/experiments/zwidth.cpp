// Z-width: the stiffest wall that each coupling renders well, against eta, tick, encoders, the
// hand's mass and the device's delay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/tap_bench.h"

namespace limpid {
namespace {

constexpr double kFine = 1e-4;  // of a fine encoder [rad]
constexpr double kWallEtas[] = {0.2, 0.3, 0.45, 0.6, 0.8, 1, 2, 4};
constexpr double kTicks[] = {0.00025, 0.0005, 0.001, 0.002};               // [s]
constexpr double kSteps[] = {1e-5, 3e-5, 1e-4, 1.5e-4, 2e-4, 5e-4, 1e-3};  // [rad]
constexpr double kMasses[] = {0.02, 0.05, 0.1, 0.2, 0.5, 1};               // [kg]
constexpr double kDelays[] = {0, 1, 2, 3, 4, 6};                           // [ticks]
constexpr double kOwnEtas[] = {0.3, 0.6, 1, 2};
constexpr double kOwnPress = 2;  // within the arm's own motors [N]

// A curve of stiffest walls: one point for each value that its panel varies.
struct WallCurve {
  std::size_t panel;
  std::string label;
  const char* ink;
  std::vector<std::pair<double, TapSetting>> points = {};
};

template <class Values, class Field>
WallCurve curve(std::size_t panel, const std::string& label, const char* ink,
                const TapSetting& base, Field TapSetting::*field, const Values& values) {
  WallCurve c{panel, label, ink};
  for (const double value : values) {
    TapSetting s = base;
    s.*field = value;
    c.points.emplace_back(value, s);
  }
  return c;
}

std::vector<WallCurve> all_curves() {
  using enum CouplingKind;
  const TapSetting exact{}, fine{.encoder_step = kFine}, paper{.kind = proposed},
      unprepared{.expects_a_mass = false}, unaware{.knows_delay = false},
      own{.press = kOwnPress, .own_motors = true},
      own_paper{.kind = proposed, .press = kOwnPress, .own_motors = true};
  const std::string quantised = fmt::format("predictive, encoder {} rad", kFine);
  return {
      curve(0, "predictive", kPredictiveInk, exact, &TapSetting::eta, kWallEtas),
      curve(0, quantised, kPredictiveTint, fine, &TapSetting::eta, kWallEtas),
      curve(0, "proposed", kProposedInk, paper, &TapSetting::eta, kWallEtas),
      curve(1, "predictive", kPredictiveInk, exact, &TapSetting::tick, kTicks),
      curve(1, quantised, kPredictiveTint, fine, &TapSetting::tick, kTicks),
      curve(1, "proposed", kProposedInk, paper, &TapSetting::tick, kTicks),
      curve(2, "predictive", kPredictiveInk, exact, &TapSetting::encoder_step, kSteps),
      curve(2, "proposed", kProposedInk, paper, &TapSetting::encoder_step, kSteps),
      curve(3, "predictive", kPredictiveInk, exact, &TapSetting::hand_mass, kMasses),
      curve(3, "predictive, one predictor", kEnergyInk, unprepared, &TapSetting::hand_mass,
            kMasses),
      curve(3, "proposed", kProposedInk, paper, &TapSetting::hand_mass, kMasses),
      curve(4, "predictive, delay known", kPredictiveInk, exact, &TapSetting::delay, kDelays),
      curve(4, "the same, encoder 0.0001 rad", kPredictiveTint, fine, &TapSetting::delay, kDelays),
      curve(4, "predictive, delay not known", kEnergyInk, unaware, &TapSetting::delay, kDelays),
      curve(4, "proposed", kProposedInk, paper, &TapSetting::delay, kDelays),
      curve(5, "predictive", kPredictiveInk, own, &TapSetting::eta, kOwnEtas),
      curve(5, "proposed", kProposedInk, own_paper, &TapSetting::eta, kOwnEtas)};
}

// Stiffest walls by theory, in the grip of the benches.
struct Theory {
  const ExperimentArm& on;
  TipAlong tip = tip_at_table(on);

  WallSetting setting(double T) const {
    const Parameters& p = on.settings;
    return {.T = T, .k_vc = p.k_vc, .b_v = p.b_v, .hand_damping = TapBench::kGripDamping};
  }
  double proposed(double eta, double T, double delay = 0) const {
    WallSetting s = setting(T);
    s.eta = eta;
    s.delay = delay;
    return proposed_wall(tip, s);
  }
  double any_linear(double T, double delay = 0) const { return every_hands_wall(tip, T, delay); }
  double mistaken(double mass, double T) const {
    WallSetting s = setting(T);
    s.hand_mass = mass;
    return mistaken_wall(tip, s);
  }
};

template <class Value>
Series theory(const std::string& label, const char* ink, double from, double to, const Value& value,
              bool even = false) {
  Series line{label, ink, Series::Style::dashed, {}};
  constexpr int kPoints = 60;
  for (int i = 0; i <= kPoints; ++i) {
    const double part = static_cast<double>(i) / kPoints;
    const double x = even ? from + part * (to - from) : from * std::pow(to / from, part);
    line.points.push_back({x, value(x)});
  }
  return line;
}

std::vector<FigurePanel> empty_panels(const ExperimentArm& on) {
  const Theory law{on};
  const double T = TapSetting{}.tick;
  const auto panel = [](const std::string& title, const std::string& x, double from, double to) {
    return FigurePanel{.title = title,
                       .x_label = x,
                       .y_label = "stiffest wall [N/m]",
                       .log_x = true,
                       .log_y = true,
                       .x_range = std::pair(from, to),
                       .y_range = std::pair(0.8 * kSoftest, 1.5 * kStiffest)};
  };
  std::vector<FigurePanel> panels{
      panel("Against eta", "eta [-]", 0.1, 10),
      panel("Against the tick, eta = 1", "tick [ms]", 0.1, 10),
      panel("Against the encoder step, eta = 1", "encoder step [mrad]", 0.009, 1.1),
      panel("Against the hand's mass, eta = 1", "mass of the hand at the tip [kg]", 0.018, 1.1),
      panel("Against the device's delay, eta = 1", "delay [ms]", -0.2, 6.2),
      panel(fmt::format("With the arm's own motors, pressed with {} N", kOwnPress), "eta [-]", 0.1,
            10)};
  panels[4].log_x = false;
  panels[0].series = {theory("proposed: damping divided by lag", kProposedInk, 0.2, 4,
                             [&](double eta) { return law.proposed(eta, T); }),
                      theory("stiffest plain spring that is passive in every hand", kNeutralInk,
                             0.2, 4, [&](double) { return law.any_linear(T); })};
  panels[1].series = {theory("proposed: damping divided by lag", kProposedInk, 0.25, 2,
                             [&](double ms) { return law.proposed(1, 1e-3 * ms); }),
                      theory("stiffest plain spring that is passive in every hand", kNeutralInk,
                             0.25, 2, [&](double ms) { return law.any_linear(1e-3 * ms); })};
  panels[3].series = {theory("one predictor: energy given by its error", kEnergyInk, 0.02, 1,
                             [&](double m) { return law.mistaken(m, T); })};
  panels[4].series = {theory(
                          "proposed: damping divided by lag", kProposedInk, 0, 6,
                          [&](double ms) { return law.proposed(1, T, 1e-3 * ms); }, true),
                      theory(
                          "stiffest plain spring that is passive in every hand", kNeutralInk, 0, 6,
                          [&](double ms) { return law.any_linear(T, 1e-3 * ms); }, true)};
  return panels;
}

struct Found {
  const ExperimentArm& on;
  std::vector<WallCurve> curves;
  std::vector<std::vector<double>> walls;  // of each curve's points [N/m]

  // The softest of a curve's walls whose value satisfies `which`; NaN if there is none.
  template <class Which>
  double softest(std::size_t curve, const Which& which) const {
    double least = std::nan("");
    for (std::size_t i = 0; i < walls[curve].size(); ++i) {
      if (!which(curves[curve].points[i].first)) continue;
      least = std::isnan(least) ? walls[curve][i] : worse_low(least, walls[curve][i]);
    }
    return least;
  }
  // The least ratio of a wall to the one that `limpid analyze` computes, clamped to the walls
  // tried.
  double least_of_named(std::size_t curve) const {
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < walls[curve].size(); ++i) {
      const double named =
          std::clamp(named_wall(on, curves[curve].points[i].second), kSoftest, kStiffest);
      least = worse_low(least, walls[curve][i] / named);
    }
    return least;
  }
};

// Finds all walls; equal settings of different curves are searched once.
Found find_all(TrialRunner& lab) {
  Found found{lab.arm(), all_curves(), {}};
  std::vector<TapSetting> settings;
  for (const WallCurve& c : found.curves) {
    for (const auto& [x, s] : c.points) {
      if (std::ranges::find(settings, s) == settings.end()) settings.push_back(s);
    }
  }
  const std::vector<double> walls = stiffest_walls(lab, settings);
  for (const WallCurve& c : found.curves) {
    found.walls.emplace_back();
    for (const auto& [x, s] : c.points) {
      const auto at = std::ranges::find(settings, s) - settings.begin();
      found.walls.back().push_back(walls[static_cast<std::size_t>(at)]);
    }
  }
  return found;
}

std::vector<FigurePanel> draw(const Found& found) {
  constexpr double kScale[] = {1, 1e3, 1e3, 1, 1, 1};  // of each panel's axis
  std::vector<FigurePanel> panels = empty_panels(found.on);
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    const WallCurve& c = found.curves[i];
    Series line{c.label, c.ink, Series::Style::line, {}};
    for (std::size_t k = 0; k < c.points.size(); ++k) {
      line.points.push_back({kScale[c.panel] * c.points[k].first, found.walls[i][k]});
    }
    Series dots{"", c.ink, Series::Style::points, line.points};
    panels[c.panel].series.push_back(line);
    panels[c.panel].series.push_back(dots);
  }
  return panels;
}

// The worst of taps at 5000 N/m over grips and etas.
Touch worst_tap(TrialRunner& lab, TapSetting s) {
  std::vector<TapBench> benches;
  std::vector<Trial> trials;
  for (const double grip : kGrips) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      s.eta = eta;
      benches.emplace_back(lab.arm(), s, 5000, grip, 3);
      trials.push_back(benches.back().trial());
    }
  }
  std::vector<Touch> touches(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { touches[i] = benches[i].touch(r); });
  Touch worst{.felt = 1};
  for (const Touch& t : touches) {
    worst.energy = worse(worst.energy, t.energy);
    worst.port = worse(worst.port, t.port);
    worst.chatter = worse(worst.chatter, t.chatter);
    if (!(std::abs(t.felt - 1) <= std::abs(worst.felt - 1))) worst.felt = t.felt;
  }
  return worst;
}

void judge_taps(TrialRunner& lab, std::vector<Check>& checks) {
  for (const auto& [mass, quiet] : {std::pair(0.0, 1e-4), {0.2, 4e-3}}) {
    const std::string where = fmt::format("5000 N/m, eta 0.3 to 1, hand of {} kg", mass);
    const Touch exact = worst_tap(lab, {.hand_mass = mass}),
                fine = worst_tap(lab, {.encoder_step = kFine, .hand_mass = mass});
    checks.push_back(at_most(where + ", exact encoders: highest E_c [J]", exact.energy, 5e-5));
    checks.push_back(at_most(
        where + ", exact encoders: relative deviation of the stiffness felt from the stiffness set",
        std::abs(exact.felt - 1), 0.01));
    checks.push_back(at_most(where + ", exact encoders: chatter [m/s]", exact.chatter, quiet));
    checks.push_back(at_most(
        where + ", encoders of 1e-4 rad: largest energy given to the human [J]", fine.port, 5e-5));
    checks.push_back(at_most(where + ", encoders of 1e-4 rad: highest E_c [J]", fine.energy, 4e-3));
    checks.push_back(at_most(where + ", encoders of 1e-4 rad: chatter [m/s]", fine.chatter, 0.02));
  }
  const Touch own = worst_tap(lab, {.press = kOwnPress, .own_motors = true});
  const std::string where =
      fmt::format("5000 N/m, eta 0.3 to 1, the arm's own motors, pressed with {} N: ", kOwnPress);
  checks.push_back(at_most(where + "highest E_c [J]", own.energy, 5e-5));
  checks.push_back(
      at_most(where + "relative deviation of the stiffness felt from the stiffness set",
              std::abs(own.felt - 1), 0.01));
  checks.push_back(at_most(where + "chatter [m/s]", own.chatter, 1e-4));
}

// Checks every curve of the predictive coupling against `limpid analyze`, as finely as the search
// goes.
void judge_named(const Found& found, std::vector<Check>& checks) {
  const double finest = std::pow(kSoftest / kStiffest, 1.0 / (1 << kBisections));
  constexpr std::pair<std::size_t, const char*> kCurves[] = {
      {0, "eta 0.2 to 4"},
      {1, "eta 0.2 to 4, encoders of 1e-4 rad"},
      {3, "ticks of 0.25 to 2 ms"},
      {4, "ticks of 0.25 to 2 ms, encoders of 1e-4 rad"},
      {6, "encoders of 1e-5 to 1e-3 rad"},
      {8, "hands up to 1 kg"},
      {9, "hands up to 1 kg, one predictor"},
      {11, "delays up to 6 ms, known"},
      {12, "delays up to 6 ms, known, encoders of 1e-4 rad"},
      {13, "delays up to 6 ms, not known"}};
  for (const auto& [curve, which] : kCurves) {
    checks.push_back(at_least(
        fmt::format(
            "predictive, {}: stiffest wall, divided by the wall that `limpid analyze` computes",
            which),
        found.least_of_named(curve), finest));
  }
}

}  // namespace

Outcome zwidth(TrialRunner& lab) {
  const Found found = find_all(lab);
  Outcome outcome;
  outcome.figure.title = "The stiffest wall that is rendered well";
  outcome.figure.caption = fmt::format(
      "The tip taps a wall at {} m/s, presses with {} N and holds, in grips of {} and {} N/m with "
      "{} N s/m. If a quantity is not varied: the tick is 1 ms, encoders are exact, the hand has "
      "no mass, and there is no delay. Motors of {} N m never reach their limit; the last panel "
      "has the arm's own motors. A wall is rendered well if the human is given at most {} mJ, the "
      "rms speed of the tip above {} Hz is at most {} mm/s, and the stiffness felt differs from "
      "the stiffness set by at most {} %. With exact encoders E_c must be at most {} mJ as well. "
      "Walls of {} to {} N/m were tried. Where a curve is at the top, no wall of this range is too "
      "stiff. Where a curve is at the bottom, no wall is rendered well. Each quantity is varied "
      "alone or together with the encoder step. A delay, another tick and a mass at the same time "
      "were not tried. The experiment walls has other arms, the experiment delay has other etas "
      "with a delay.",
      TapBench::kSpeed, TapSetting{}.press, kGrips[0], kGrips[1], TapBench::kGripDamping,
      TapSetting{}.torque_limit, 1e3 * WellRendered::kPort, TapBench::kFast,
      1e3 * WellRendered::kChatter, 100 * WellRendered::kFelt, 1e3 * WellRendered::kEnergy,
      kSoftest, kStiffest);
  outcome.figure.columns = 2;
  outcome.figure.panels = draw(found);
  const auto any = [](double) { return true; };
  outcome.checks = {at_least("predictive: stiffest wall, exact encoders, eta 0.2 to 4 [N/m]",
                             found.softest(0, any), 10000),
                    at_least("predictive: stiffest wall, exact encoders, hands up to 0.2 kg [N/m]",
                             found.softest(8, [](double mass) { return mass <= 0.2; }), 10000),
                    at_least("predictive: stiffest wall, encoders up to 1e-4 rad [N/m]",
                             found.softest(6, [](double step) { return step <= kFine; }), 5000),
                    at_least("predictive: stiffest wall, encoders of 5e-4 rad [N/m]",
                             found.softest(6, [](double step) { return step == 5e-4; }), 1000),
                    at_least("predictive: stiffest wall, the arm's own motors, eta 0.3 to 2 [N/m]",
                             found.softest(15, any), 10000)};
  judge_named(found, outcome.checks);
  judge_taps(lab, outcome.checks);
  return outcome;
}

}  // namespace limpid
