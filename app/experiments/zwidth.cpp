// How stiff a wall each coupling renders well: against eta, tick, encoders, the hand's mass and the
// device's delay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/wall_search.h"

namespace limpid {
namespace {

constexpr double kFine = 1e-4;  // of a fine encoder [rad]
constexpr double kEtas[] = {0.2, 0.3, 0.45, 0.6, 0.8, 1, 2, 4};
constexpr double kTicks[] = {0.00025, 0.0005, 0.001, 0.002};               // [s]
constexpr double kSteps[] = {1e-5, 3e-5, 1e-4, 1.5e-4, 2e-4, 5e-4, 1e-3};  // [rad]
constexpr double kMasses[] = {0.02, 0.05, 0.1, 0.2, 0.5, 1};               // [kg]
constexpr double kDelays[] = {0, 1, 2, 3, 4, 6};                           // [ticks]

// A boundary to be found: one point for each value of what its panel varies.
struct Curve {
  std::size_t panel;
  std::string label;
  const char* ink;
  std::vector<std::pair<double, TapSetting>> points = {};
};

template <class Values, class Field>
Curve curve(std::size_t panel, const std::string& label, const char* ink, const TapSetting& base,
            Field TapSetting::*field, const Values& values) {
  Curve c{panel, label, ink};
  for (const double value : values) {
    TapSetting s = base;
    s.*field = value;
    c.points.emplace_back(value, s);
  }
  return c;
}

std::vector<Curve> all_curves() {
  using enum CouplingKind;
  const TapSetting exact{}, fine{.encoder_step = kFine}, paper{.kind = proposed},
      unprepared{.expects_a_mass = false}, unaware{.knows_delay = false};
  const std::string quantised = fmt::format("predictive, encoder {} rad", kFine);
  return {
      curve(0, "predictive", kPredictiveInk, exact, &TapSetting::eta, kEtas),
      curve(0, quantised, kPredictiveTint, fine, &TapSetting::eta, kEtas),
      curve(0, "proposed", kProposedInk, paper, &TapSetting::eta, kEtas),
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
      curve(4, "proposed", kProposedInk, paper, &TapSetting::delay, kDelays)};
}

// What theory says, in the hand of the benches.
struct Theory {
  TipAlong tip = tip_at_table();

  static WallSetting setting(double T) {
    const Parameters p;
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

std::vector<FigurePanel> empty_panels() {
  const Theory law;
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
      panel("Against the scaling of the inertia", "eta [-]", 0.1, 10),
      panel("Against the tick, eta = 1", "tick [ms]", 0.1, 10),
      panel("Against the step of the encoders, eta = 1", "encoder step [mrad]", 0.009, 1.1),
      panel("Against the mass of the hand, eta = 1", "mass of the hand at the tip [kg]", 0.018,
            1.1),
      panel("Against the device's delay, eta = 1", "delay [ms]", -0.2, 6.2)};
  panels[4].log_x = false;
  panels[0].series = {theory("proposed: damping over lag", kProposedInk, 0.2, 4,
                             [&](double eta) { return law.proposed(eta, T); }),
                      theory("passive in every hand, any linear law", kNeutralInk, 0.2, 4,
                             [&](double) { return law.any_linear(T); })};
  panels[1].series = {theory("proposed: damping over lag", kProposedInk, 0.25, 2,
                             [&](double ms) { return law.proposed(1, 1e-3 * ms); }),
                      theory("passive in every hand, any linear law", kNeutralInk, 0.25, 2,
                             [&](double ms) { return law.any_linear(1e-3 * ms); })};
  panels[3].series = {theory("one predictor: what its error gives away", kEnergyInk, 0.02, 1,
                             [&](double m) { return law.mistaken(m, T); })};
  panels[4].series = {theory(
                          "proposed: damping over lag", kProposedInk, 0, 6,
                          [&](double ms) { return law.proposed(1, T, 1e-3 * ms); }, true),
                      theory(
                          "passive in every hand, any linear law", kNeutralInk, 0, 6,
                          [&](double ms) { return law.any_linear(T, 1e-3 * ms); }, true)};
  return panels;
}

struct Found {
  std::vector<Curve> curves;
  std::vector<std::vector<double>> walls;  // of each curve's points [N/m]

  // The softest of a curve's walls where `which` holds for the value.
  template <class Which>
  double softest(std::size_t curve, const Which& which) const {
    double least = kStiffest;
    for (std::size_t i = 0; i < walls[curve].size(); ++i) {
      if (which(curves[curve].points[i].first)) least = std::min(least, walls[curve][i]);
    }
    return least;
  }
};

// Equal settings of different curves are looked at once.
Found find_all(Laboratory& lab) {
  Found found{all_curves(), {}};
  std::vector<TapSetting> settings;
  for (const Curve& c : found.curves) {
    for (const auto& [x, s] : c.points) {
      if (std::ranges::find(settings, s) == settings.end()) settings.push_back(s);
    }
  }
  const std::vector<double> walls = stiffest_walls(lab, settings);
  for (const Curve& c : found.curves) {
    found.walls.emplace_back();
    for (const auto& [x, s] : c.points) {
      const auto at = std::ranges::find(settings, s) - settings.begin();
      found.walls.back().push_back(walls[static_cast<std::size_t>(at)]);
    }
  }
  return found;
}

std::vector<FigurePanel> draw(const Found& found) {
  constexpr double kScale[] = {1, 1e3, 1e3, 1, 1};  // of each panel's axis
  std::vector<FigurePanel> panels = empty_panels();
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    const Curve& c = found.curves[i];
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
Touch worst_tap(Laboratory& lab, double encoder_step, double mass) {
  std::vector<TapBench> benches;
  std::vector<Trial> trials;
  for (const double grip : kGrips) {
    for (const double eta : {1.0, 0.6, 0.3}) {
      const TapSetting s{.eta = eta, .encoder_step = encoder_step, .hand_mass = mass};
      benches.emplace_back(s, 5000, grip, 3);
      trials.push_back(benches.back().trial());
    }
  }
  std::vector<Touch> touches(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { touches[i] = benches[i].touch(r); });
  Touch worst{.felt = 1};
  for (const Touch& t : touches) {
    worst.energy = std::max(worst.energy, t.energy);
    worst.port = std::max(worst.port, t.port);
    worst.chatter = std::max(worst.chatter, t.chatter);
    if (std::abs(t.felt - 1) > std::abs(worst.felt - 1)) worst.felt = t.felt;
  }
  return worst;
}

void judge_taps(Laboratory& lab, std::vector<Check>& checks) {
  for (const auto& [mass, quiet] : {std::pair(0.0, 1e-4), {0.2, 4e-3}}) {
    const std::string where = fmt::format("5000 N/m, eta 0.3 to 1, hand of {} kg", mass);
    const Touch exact = worst_tap(lab, 0, mass), fine = worst_tap(lab, kFine, mass);
    checks.push_back(at_most(where + ", exact encoders: highest E_c [J]", exact.energy, 5e-5));
    checks.push_back(at_most(where + ", exact encoders: stiffness felt off that set, of it",
                             std::abs(exact.felt - 1), 0.01));
    checks.push_back(at_most(where + ", exact encoders: chatter [m/s]", exact.chatter, quiet));
    checks.push_back(
        at_most(where + ", encoders of 1e-4 rad: given to the human [J]", fine.port, 5e-5));
    checks.push_back(at_most(where + ", encoders of 1e-4 rad: highest E_c [J]", fine.energy, 4e-3));
    checks.push_back(at_most(where + ", encoders of 1e-4 rad: chatter [m/s]", fine.chatter, 0.02));
  }
}

}  // namespace

Outcome zwidth(Laboratory& lab) {
  const Found found = find_all(lab);
  Outcome outcome;
  outcome.figure.title = "The stiffest wall that is rendered well";
  outcome.figure.caption = fmt::format(
      "Taps at {} m/s, {} N, held, in hands of {} and {} N/m and {} N s/m; tick 1 ms, exact "
      "encoders, no mass unless varied. Well: at most {} mJ given to the human, tip above {} Hz "
      "at most {} mm/s, stiffness felt within {} % of that set, with exact encoders E_c at most {} "
      "mJ. Walls of {} to {} N/m were tried: a curve at the top has no limit in them, one at the "
      "bottom renders none.",
      TapBench::kSpeed, TapSetting{}.press, kGrips[0], kGrips[1], TapBench::kGripDamping,
      1e3 * WellRendered::kPort, TapBench::kFast, 1e3 * WellRendered::kChatter,
      100 * WellRendered::kFelt, 1e3 * WellRendered::kEnergy, kSoftest, kStiffest);
  outcome.figure.columns = 2;
  outcome.figure.panels = draw(found);
  const auto any = [](double) { return true; };
  outcome.checks = {at_least("predictive: stiffest wall, exact encoders, eta 0.2 to 4 [N/m]",
                             found.softest(0, any), 10000),
                    at_least("predictive: stiffest wall, exact encoders, hands to 0.2 kg [N/m]",
                             found.softest(8, [](double mass) { return mass <= 0.2; }), 10000),
                    at_least("predictive: stiffest wall, encoders to 1e-4 rad [N/m]",
                             found.softest(6, [](double step) { return step <= kFine; }), 5000),
                    at_least("predictive: stiffest wall, encoders of 5e-4 rad [N/m]",
                             found.softest(6, [](double step) { return step == 5e-4; }), 1000)};
  judge_taps(lab, outcome.checks);
  return outcome;
}

}  // namespace limpid
