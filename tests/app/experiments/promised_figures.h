// Figures of experiments that are run as a whole only once: their curves against their checks and
// against closed forms.
#pragma once

#include <map>
#include <numbers>

#include "app/experiments/body_theory.h"
#include "app/experiments/tap_bench.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/random.h"
#include "core/dynamics/random_arm.h"
#include "tests/app/experiments/made.h"

namespace limpid::test {

// An outcome whose panels, curves and checks are found by their words.
class Promised {
 public:
  explicit Promised(const Outcome& outcome) : outcome_(outcome) {}

  const std::vector<Check>& checks() const { return outcome_.checks; }
  const std::string& caption() const { return outcome_.figure.caption; }
  double check(const std::string& what) const {
    const auto found = std::ranges::find(outcome_.checks, what, &Check::what);
    EXPECT_NE(found, outcome_.checks.end()) << what;
    return found == outcome_.checks.end() ? std::nan("") : found->value;
  }
  const FigurePanel& panel(const std::string& title) const {
    static const FigurePanel kNone;
    const auto found = std::ranges::find(outcome_.figure.panels, title, &FigurePanel::title);
    EXPECT_NE(found, outcome_.figure.panels.end()) << "no panel \"" << title << '"';
    return found == outcome_.figure.panels.end() ? kNone : *found;
  }
  bool has(const std::string& title, const std::string& label) const {
    const auto& all = panel(title).series;
    return std::ranges::find(all, label, &Series::label) != all.end();
  }
  const Series& curve(const std::string& title, const std::string& label) const {
    static const Series kNone;
    const auto& all = panel(title).series;
    const auto found = std::ranges::find(all, label, &Series::label);
    EXPECT_NE(found, all.end()) << title << ": no curve \"" << label << '"';
    return found == all.end() ? kNone : *found;
  }
  // The curve right behind that one, or right before it.
  const Series& beside(const std::string& title, const std::string& label, int by) const {
    static const Series kNone;
    const auto& all = panel(title).series;
    const auto at = std::ranges::find(all, label, &Series::label) - all.begin() + by;
    const bool there = at >= 0 && at < static_cast<std::ptrdiff_t>(all.size());
    EXPECT_TRUE(there) << title << ": nothing beside \"" << label << '"';
    return there ? all[static_cast<std::size_t>(at)] : kNone;
  }

 private:
  const Outcome& outcome_;
};

inline double y_at(const Series& curve, double x) {
  for (const FigurePoint& p : curve.points) {
    if (std::abs(p.x - x) < 1e-9) return p.y;
  }
  ADD_FAILURE() << curve.label << ": no point at " << x;
  return std::nan("");
}

inline double least_y(const Series& curve, double from = -HUGE_VAL, double to = HUGE_VAL) {
  double least = HUGE_VAL;
  for (const FigurePoint& p : curve.points) {
    if (p.x >= from && p.x <= to) least = std::min(least, p.y);
  }
  return least;
}

// Farthest of all points from a value.
inline double farthest_y(const Series& curve, double from) {
  double most = 0;
  for (const FigurePoint& p : curve.points) most = std::max(most, std::abs(p.y - from));
  return most;
}

inline void expect_xs(const Series& curve, const std::vector<double>& xs) {
  ASSERT_EQ(curve.points.size(), xs.size()) << curve.label;
  for (std::size_t i = 0; i < xs.size(); ++i) {
    EXPECT_NEAR(curve.points[i].x, xs[i], 1e-9 * std::max(1.0, xs[i])) << curve.label;
  }
}

// A curve's points are drawn as dots as well.
inline void expect_dots(const Series& line, const Series& dots) {
  EXPECT_EQ(dots.label, "") << line.label;
  EXPECT_EQ(dots.color, line.color) << line.label;
  EXPECT_EQ(dots.style, Series::Style::points) << line.label;
  ASSERT_EQ(dots.points.size(), line.points.size()) << line.label;
  for (std::size_t i = 0; i < dots.points.size(); ++i) {
    EXPECT_EQ(dots.points[i].x, line.points[i].x) << line.label;
    EXPECT_EQ(dots.points[i].y, line.points[i].y) << line.label;
  }
}

// Every curve has a point at each eta, and the worst of all is what the check says.
inline void expect_delay(const Promised& shown) {
  const struct {
    const char *title, *what;
    double scale, wanted, least;
  } kPanels[] = {
      {"Free motion: largest energy given to the hand",
       "largest energy given to the human in free motion [J]", 1e3, 0, 1e-3},
      {"Wall by `limpid analyze`: largest energy given to the hand",
       "largest energy given to the human at the wall that `limpid analyze` computes [J]", 1e3, 0,
       1e-3},
      {"Inertia felt up to 1 Hz: deviation from the wanted inertia",
       "deviation of the inertia felt up to 1 Hz from the inertia that `limpid analyze` computes, "
       "divided by the larger of eta and 1",
       1, 0, 0},
      {"Stiffness felt at the wall, divided by the stiffness set",
       "relative deviation of the stiffness felt at that wall from the stiffness set", 1, 1, 0}};
  const std::string named = "The wall that `limpid analyze` computes";
  for (const bool known : {true, false}) {
    std::vector<std::string> labels;
    if (known) labels.emplace_back("none");
    for (int ms = 1; ms <= 3; ++ms) {
      labels.push_back(fmt::format("{} ms{}", ms, known ? "" : ", not known"));
    }
    const std::string where =
        known ? "delay of 0 to 3 ms, known: " : "delay of 1 to 3 ms, not known: ";
    for (const auto& panel : kPanels) {
      double worst = 0;
      for (const std::string& label : labels) {
        const Series& line = shown.curve(panel.title, label);
        expect_xs(line, {0.1, 0.2, 0.5, 1, 2, 3.5, 5});
        EXPECT_EQ(line.style, known ? Series::Style::line : Series::Style::dashed) << label;
        expect_dots(line, shown.beside(panel.title, label, 1));
        worst = std::max(worst, farthest_y(line, panel.wanted));
      }
      EXPECT_NEAR(worst, std::max(panel.least, panel.scale * shown.check(where + panel.what)), 1e-9)
          << panel.title;
    }
    const Series& walls = shown.curve(named, known ? "known" : "not known");
    expect_xs(walls, {0, 1, 2, 3});
    for (const FigurePoint& p : walls.points) {
      const TapSetting s{
          .eta = 0.1, .press = 2, .own_motors = true, .delay = p.x, .knows_delay = known};
      EXPECT_NEAR(p.y, std::max(100.0, named_wall(built_in_arm(), s)), 1e-9 * p.y) << p.x;
      EXPECT_GE(p.y, shown.check(where + "softest wall that `limpid analyze` computes [N/m]"));
    }
  }
  for (const std::size_t i : {0, 1}) {
    expect_on(shown.curve(kPanels[i].title, "bound"), [](double) { return 5.0; });
  }
  for (const std::size_t i : {2, 3}) {
    const double wanted = kPanels[i].wanted;
    expect_on(shown.curve(kPanels[i].title, "bounds"), [&](double) { return wanted + 0.05; });
    expect_on(shown.beside(kPanels[i].title, "bounds", 1), [&](double) { return wanted - 0.05; });
  }
}

// Settings that occur in several panels have the same wall there; checks are about its curves.
inline void expect_zwidth_walls(const Promised& shown) {
  const std::string eta = "Against eta", tick = "Against the tick, eta = 1",
                    step = "Against the encoder step, eta = 1",
                    mass = "Against the hand's mass, eta = 1",
                    late = "Against the device's delay, eta = 1",
                    own = "With the arm's own motors, pressed with 2 N",
                    coarse = "predictive, encoder 0.0001 rad";
  const std::tuple<std::string, double, double> kAxes[] = {{eta, 0.2, 4},   {tick, 0.25, 2},
                                                           {step, 0.01, 1}, {mass, 0.02, 1},
                                                           {late, 0, 6},    {own, 0.3, 2}};
  for (const auto& [title, from, to] : kAxes) {
    for (const Series& s : shown.panel(title).series) {
      if (s.style != Series::Style::line) continue;
      expect_from_to(s, from, to, 1e-9);
      expect_dots(s, shown.beside(title, s.label, 1));
      for (const FigurePoint& p : s.points) {
        EXPECT_GE(p.y, 100 - 1e-9) << title << ", " << s.label;
        EXPECT_LE(p.y, 20000 + 1e-9) << title << ", " << s.label;
      }
    }
  }
  const auto wall = [&](const std::string& title, const std::string& label, double x) {
    return y_at(shown.curve(title, label), x);
  };
  EXPECT_EQ(wall(eta, "predictive", 1), wall(tick, "predictive", 1));
  EXPECT_EQ(wall(eta, "predictive", 1), wall(late, "predictive, delay known", 0));
  EXPECT_EQ(wall(eta, "proposed", 1), wall(tick, "proposed", 1));
  EXPECT_EQ(wall(eta, "proposed", 1), wall(late, "proposed", 0));
  EXPECT_EQ(wall(eta, coarse, 1), wall(tick, coarse, 1));
  EXPECT_EQ(wall(eta, coarse, 1), wall(step, "predictive", 0.1));
  EXPECT_EQ(wall(eta, coarse, 1), wall(late, "the same, encoder 0.0001 rad", 0));
  const auto softest = [&](const std::string& title, double from, double to) {
    return least_y(shown.curve(title, "predictive"), from - 1e-9, to + 1e-9);
  };
  const std::string which = "predictive: stiffest wall, ";
  EXPECT_EQ(shown.check(which + "exact encoders, eta 0.2 to 4 [N/m]"), softest(eta, 0.2, 4));
  EXPECT_EQ(shown.check(which + "exact encoders, hands up to 0.2 kg [N/m]"),
            softest(mass, 0.02, 0.2));
  EXPECT_EQ(shown.check(which + "encoders up to 1e-4 rad [N/m]"), softest(step, 0.01, 0.1));
  EXPECT_EQ(shown.check(which + "encoders of 5e-4 rad [N/m]"), softest(step, 0.5, 0.5));
  EXPECT_EQ(shown.check(which + "the arm's own motors, eta 0.3 to 2 [N/m]"), softest(own, 0.3, 2));
  double least = HUGE_VAL;
  for (const FigurePoint& p : shown.curve(eta, "predictive").points) {
    const double named = std::clamp(named_wall(built_in_arm(), {.eta = p.x}), 100.0, 20000.0);
    least = std::min(least, p.y / named);
  }
  EXPECT_NEAR(shown.check("predictive, eta 0.2 to 4: stiffest wall, divided by the wall that "
                          "`limpid analyze` computes"),
              least, 1e-9);
}

// Damping over lag: b_d + b_v + k_vc T/2 at the tip and 2 N s/m of the hand, over T/2 + b_v/k_vc
// and the delay; without the law's own, and without its lag, for the plain spring.
inline void expect_zwidth(const Promised& shown) {
  expect_zwidth_walls(shown);
  const ExperimentArm on = built_in_arm();
  const Parameters p;
  const TipAlong tip = tip_at_table(on);
  const auto proposed = [&](double eta, double T, double delay) {
    const double b = tip.damping + (p.b_v + p.k_vc * T / 2) / tip.lever2 + 2;
    return eta * b / (T / 2 + p.b_v / p.k_vc + delay);
  };
  const auto plain = [&](double T, double delay) { return tip.damping / (T / 2 + delay); };
  const std::string law = "proposed: damping divided by lag",
                    spring = "stiffest plain spring that is passive in every hand";
  const std::string eta = "Against eta", tick = "Against the tick, eta = 1",
                    late = "Against the device's delay, eta = 1";
  expect_on(shown.curve(eta, law), [&](double x) { return proposed(x, 1e-3, 0); });
  expect_on(shown.curve(eta, spring), [&](double) { return plain(1e-3, 0); });
  expect_on(shown.curve(tick, law), [&](double ms) { return proposed(1, 1e-3 * ms, 0); });
  expect_on(shown.curve(tick, spring), [&](double ms) { return plain(1e-3 * ms, 0); });
  expect_on(shown.curve(late, law), [&](double ms) { return proposed(1, 1e-3, 1e-3 * ms); });
  expect_on(shown.curve(late, spring), [&](double ms) { return plain(1e-3, 1e-3 * ms); });
  for (const auto& [title, from, to] :
       {std::tuple(eta, 0.2, 4.0), {tick, 0.25, 2.0}, {late, 0.0, 6.0}}) {
    for (const std::string& label : {law, spring}) {
      expect_from_to(shown.curve(title, label), from, to, 1e-9);
      EXPECT_EQ(shown.curve(title, label).style, Series::Style::dashed);
    }
  }
  // sqrt(2 b m / T^3 * (m + m_h) / m_h): its square is a line over 1/m_h, that meets zero at -m.
  const Series& mistaken =
      shown.curve("Against the hand's mass, eta = 1", "one predictor: energy given by its error");
  expect_from_to(mistaken, 0.02, 1, 1e-9);
  const FigurePoint last = mistaken.points.back();
  expect_on(mistaken, [&](double hand) {
    return last.y * std::sqrt((tip.mass + hand) / hand / ((tip.mass + last.x) / last.x));
  });
}

// An arm of `walls`, tapped by itself: what its dots have to show.
struct TappedArm {
  int joints;
  unsigned seed;
  double mass;                         // [kg]
  std::pair<double, double> grips[2];  // [N/m, N s/m]
  double hold, allowed;                // [s], [N]; 0: a tenth of the press
  double named = 0, felt = 1, rattle = 0, given = 0;

  void run() {
    const test::TempDir temp;
    TrialRunner::Options options;
    options.dir = temp / ".";
    TrialRunner lab("walls", options);
    const ArmDescription arm = weighing(random_arm(joints, seed), mass);
    const Eigen::VectorXd x = Random(seed + 1000).vector(joints, 0.6);
    Parameters p = fitted(arm);
    p.kind = CouplingKind::predictive;
    named = tip_limits(arm, x, p, {}).wall(p.kind).stiffness;
    for (const auto& [stiffness, damping] : grips) {
      p.hand_stiffness = stiffness;
      p.hand_damping = damping;
      const TapPlace place = tap_place(arm, x, p);
      const WallTap tap{.wall = named, .press = bearable_press(arm, place, p, 4), .hold = hold};
      Trial trial{"", tap_plan(arm, place, tap, p), false};
      const TrialResult result = lab.run({trial}).front();
      WallMeter meter = tap_meter(trial.plan, tap);
      for (std::size_t k = 0; k < result.session.size(); ++k) {
        meter.add(result.session.layout, result.session.row(k));
        given = std::max(given, 1e3 * result.session.at(k, Column::energy_port)[0]);
      }
      if (std::abs(meter.felt() - 1) > std::abs(felt - 1)) felt = meter.felt();
      rattle = std::max(rattle, meter.rattle() / (allowed > 0 ? allowed : tap.press / 10));
    }
  }
};

// Dots of 36 arms from 20 g to 30 kg, evenly in the logarithm, those of an encoder a little aside.
inline void expect_walls(const Promised& shown) {
  const std::string named = "The wall that `limpid analyze` computes",
                    felt = "Stiffness felt, divided by the stiffness set",
                    rattle =
                        "Force above 20 Hz while the hand presses, divided by the force allowed",
                    given = "Largest energy given to the hand";
  const std::pair<const char*, double> kEncoders[] = {
      {"exact encoders", 0.94}, {"encoders of 1e-05 rad", 1}, {"encoders of 0.0001 rad", 1.06}};
  for (const auto& [label, aside] : kEncoders) {
    const std::string where = std::string(label) + ": ";
    const auto count = static_cast<std::size_t>(shown.check(
        where + "number of arms for which `limpid analyze` computes a wall, of 36 arms"));
    std::vector<double> masses;
    for (const FigurePoint& p : shown.curve(named, label).points) {
      masses.push_back(p.x / aside);
      EXPECT_GE(p.y, 10);
      EXPECT_LE(p.y, 30000);
    }
    std::ranges::sort(masses);
    EXPECT_EQ(masses.size(), count) << label;
    for (std::size_t i = 0; masses.size() == 36 && i < 36; ++i) {
      const double mass = 0.02 * std::pow(1500, static_cast<double>(i) / 35);
      EXPECT_NEAR(masses[i], mass, 1e-6 * mass) << label;
    }
    for (const std::string& title : {felt, rattle, given}) {
      const Series& dots = shown.curve(title, label);
      ASSERT_EQ(dots.points.size(), count) << title;
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(dots.points[i].x, shown.curve(named, label).points[i].x) << title;
      }
    }
    EXPECT_NEAR(
        farthest_y(shown.curve(felt, label), 1),
        shown.check(where + "relative deviation of the stiffness felt from the stiffness set"),
        1e-12);
    EXPECT_NEAR(farthest_y(shown.curve(rattle, label), 0),
                std::max(1e-4, shown.check(where + "rms force above 20 Hz, divided by the force "
                                                   "allowed")),
                1e-12);
    EXPECT_NEAR(farthest_y(shown.curve(given, label), 0),
                std::max(1e-3, 1e3 * shown.check(where + "largest energy given to the human [J]")),
                1e-12);
  }
  expect_on(shown.curve(felt, "bounds"), [](double) { return 1.05; });
  expect_on(shown.beside(felt, "bounds", 1), [](double) { return 0.95; });
  expect_on(shown.curve(rattle, "bound"), [](double) { return 1.0; });
  expect_on(shown.curve(given, "bound"), [](double) { return 5.0; });
  // The lightest one is the first, and the heaviest one the fourteenth.
  TappedArm lightest{1, 100, 0.02, {{300, 2}, {3000, 5}}, 0.5, 0},
      heaviest{2, 113, 0.02 * power(1500, 1), {{1000, 5}, {3000, 10}}, 1, 2};
  for (TappedArm* arm : {&lightest, &heaviest}) {
    arm->run();
    const auto dot = [&](const std::string& title) {
      return y_at(shown.curve(title, "exact encoders"), 0.94 * arm->mass);
    };
    EXPECT_NEAR(dot(named), std::clamp(arm->named, 10.0, 30000.0), 1e-6 * arm->named);
    EXPECT_NEAR(dot(felt), arm->felt, 1e-6);
    EXPECT_NEAR(dot(rattle), std::clamp(arm->rattle, 1e-4, 100.0), 1e-3 * dot(rattle));
    EXPECT_NEAR(dot(given), std::clamp(arm->given, 1e-3, 1e3), 1e-3 * dot(given));
  }
}

inline double largest_given(const Promised& shown, const std::string& law) {
  double most = 0;
  for (const char* arm : {"built-in, ideal", "Touch", "omega", "Inverse3"}) {
    const Series& taps = shown.curve(fmt::format("{}: a wall of 2000 N/m", arm), law);
    EXPECT_EQ(taps.points.size(), 4u) << arm << ": a point for each hand";
    most = std::max(most, farthest_y(taps, 0));
  }
  return most;
}

// Through a link the stiffness of `wave` is that of wall, spring and line in series.
inline void expect_links(const Promised& shown) {
  const std::string title = "Built-in arm, through a link: a wall of 5000 N/m";
  const Series& theory = shown.curve(title, "wave: 1/(1/K + 1/k_vc + (link + T/2)/b)");
  ASSERT_EQ(theory.points.size(), 51u);
  expect_from_to(theory, 0, 50, 0);
  const Parameters p;
  const double of_a_ms = 1 / theory.points[1].y - 1 / theory.points[0].y;  // of line, at the tip
  const double of_k_vc = 1 / theory.points[0].y - of_a_ms / 2 - 1.0 / 5000;
  EXPECT_NEAR(of_k_vc * p.k_vc, of_a_ms / 1e-3 * p.line(), 1e-9 * of_k_vc * p.k_vc)
      << "the same lever";
  expect_on(
      theory, [&](double link) { return 1 / (1.0 / 5000 + of_k_vc + (link + 0.5) * of_a_ms); },
      1e-9);
  double off = 0, stiffer = HUGE_VAL;
  const Series &wave = shown.curve(title, "wave"), &tdpn = shown.curve(title, "tdpn");
  expect_xs(wave, {0, 1, 2, 5, 10, 20, 50});
  for (const FigurePoint& at : wave.points) {
    off = std::max(off, std::abs(at.y / y_at(theory, at.x) - 1));
    if (at.x >= 5) stiffer = std::min(stiffer, y_at(tdpn, at.x) / at.y);
  }
  EXPECT_NEAR(shown.check("wave, links up to 50 ms: relative deviation of the stiffness felt from "
                          "the stiffness of spring and line in series"),
              off, 1e-9);
  EXPECT_NEAR(shown.check("tdpn, links of 5 to 50 ms: stiffness felt, divided by the stiffness "
                          "felt with wave"),
              stiffer, 1e-9 * stiffer);
}

inline void expect_approaches(const Promised& shown) {
  const std::string arms = "The stiffest wall that is rendered well",
                    late = "Built-in arm: stiffest wall against the device's delay";
  const char* names[] = {"built-in, ideal", "Touch", "omega", "Inverse3"};
  ASSERT_EQ(shown.panel(arms).x_ticks.size(), 4u);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_EQ(shown.panel(arms).x_ticks[a],
              std::pair(static_cast<double>(a), std::string(names[a])));
  }
  EXPECT_EQ(shown.panel(arms).series.size(), 8u);
  for (const Series& law : shown.panel(arms).series) {
    ASSERT_EQ(law.points.size(), 4u) << law.label;
    for (std::size_t a = 0; a < 4; ++a) {
      EXPECT_NEAR(law.points[a].x, static_cast<double>(a), 0.45) << law.label;
      EXPECT_GE(law.points[a].y, 50 - 1e-9) << law.label;
      EXPECT_LE(law.points[a].y, 20000) << law.label;
    }
  }
  for (const char* law : {"proposed", "predictive", "direct", "popc"}) {
    expect_xs(shown.curve(late, law), {0, 1, 2, 3});
    EXPECT_EQ(shown.curve(late, law).points[0].y, shown.curve(arms, law).points[0].y)
        << law << ": the ideal arm has no delay";
  }
  // (b_d + b_h)/(T/2 + delay) and 2 b_d/(T + delay), with 2 N s/m of the hand.
  const Series &direct = shown.curve(late, "direct: (b_d + b_h)/(T/2 + delay)"),
               &eba = shown.curve(late, "eba: 2 b_d/(T + delay)");
  const double b_d = eba.points.front().y * 1e-3 / 2;
  expect_on(direct, [&](double ms) { return (b_d + 2) / (0.5e-3 + 1e-3 * ms); });
  expect_on(eba, [&](double ms) { return 2 * b_d / (1e-3 + 1e-3 * ms); });
  expect_from_to(direct, 0, 3, 1e-6);
  for (const int ms : {0, 1, 3}) {
    const std::string what = fmt::format(
        "direct, delay of {} ms: stiffest wall, divided by (b_d + b_h)/(T/2 + delay)", ms);
    const double foretold = (b_d + 2) / (0.5e-3 + 1e-3 * ms);
    EXPECT_NEAR(shown.check(what), y_at(shown.curve(late, "direct"), ms) / foretold, 1e-9);
  }
  for (const char* law : {"eba", "predictive", "tank"}) {
    const double given =
        1e3 * shown.check(fmt::format("{}, all arms: largest energy given to the hand [J]", law));
    EXPECT_NEAR(largest_given(shown, law), std::max(1e-4, given), 1e-12) << law;
  }
  expect_links(shown);
}

// Dots in the order of the checks, each its error over its limit, by the sign of the error.
inline void expect_errors(const Promised& shown, const std::string& tick, std::size_t first,
                          std::size_t count) {
  const std::string title = "Errors divided by their limits, tick " + tick;
  std::map<double, std::pair<double, bool>> dots;
  for (const bool above : {true, false}) {
    for (const FigurePoint& p :
         shown.curve(title, above ? "above theory" : "below theory").points) {
      EXPECT_TRUE(dots.emplace(p.x, std::pair(p.y, above)).second) << p.x;
    }
  }
  auto dot = dots.begin();
  for (std::size_t i = first; i < first + count; ++i) {
    const Check& check = shown.checks()[i];
    EXPECT_TRUE(check.what.find("tick " + tick) != std::string::npos) << check.what;
    ASSERT_TRUE(check.against) << check.what;
    if (!check.against->expected) continue;
    const double measured = check.against->measured, expected = *check.against->expected;
    const bool relative = check.what.ends_with("error [%]");
    const double error = relative ? 100 * (measured / expected - 1) : measured - expected;
    EXPECT_NEAR(check.value, std::abs(error), 1e-12 * std::max(1.0, check.value)) << check.what;
    ASSERT_NE(dot, dots.end()) << check.what;
    const double y = std::clamp(check.value / check.bound, 1.2e-4, 0.8e4);
    EXPECT_NEAR(dot->second.first, y, 1e-9 * y) << check.what;
    EXPECT_EQ(dot->second.second, error > 0) << check.what;
    ++dot;
  }
  EXPECT_EQ(dot, dots.end()) << "a dot of nothing";
  const auto& ticks = shown.panel(title).x_ticks;
  for (const auto& [x, y] : dots) {
    const double nearest = std::round(x);
    EXPECT_LE(std::abs(x - nearest), 0.4);
    EXPECT_TRUE(nearest >= 0 && nearest < static_cast<double>(ticks.size()));
  }
  expect_on(shown.curve(title, "limit"), [](double) { return 1.0; });
}

inline void expect_bodies(const Promised& shown) {
  const std::size_t of_a_tick = (shown.checks().size() - 2) / 2;
  expect_errors(shown, "1 ms", 0, of_a_tick);
  expect_errors(shown, "0.25 ms", of_a_tick, of_a_tick);
  // g sin 20 degrees, over 1 + I / (m r^2): 7/5 of a ball, 3/2 of a cylinder.
  const std::string roll = "Rolling down a slope of 20 degrees, tick 1 ms";
  const double along = kStandardGravity * std::sin(20 * std::numbers::pi / 180);
  for (const auto& [name, least, most] : {std::tuple("ball", 5.0 / 7, 5.0 / 7),
                                          {"cylinder", 2.0 / 3, 2.0 / 3},
                                          {"capsule", 2.0 / 3, 5.0 / 7}}) {
    const Series &way = shown.curve(roll, name), &theory = shown.beside(roll, name, 1);
    const double a = 2 * theory.points.back().y;
    EXPECT_GE(a, along * least * (1 - 1e-9)) << name;
    EXPECT_LE(a, along * most * (1 + 1e-9)) << name;
    expect_on(theory, [&](double t) { return a * t * t / 2; });
    expect_from_to(theory, 0, 1, 1e-9);
    EXPECT_EQ(theory.style, Series::Style::dashed);
    ASSERT_EQ(way.points.size(), 101u) << name;
    expect_from_to(way, 0, 1, 1e-9);
    for (const FigurePoint& p : way.points) {
      EXPECT_NEAR(p.y, a * p.x * p.x / 2, 0.005 * a * p.x / 2) << name << " at " << p.x;
    }
  }
  const std::string swing = "Energy of a pendulum during one minute, tick 1 ms";
  for (const char* joint : {"hinge", "ball joint"}) {
    for (const char* amplitude : {"0.1", "2.5"}) {
      const Series& curve =
          shown.curve(swing, fmt::format("swings on a {}, {} rad", joint, amplitude));
      ASSERT_EQ(curve.points.size(), 52u) << "from ten seconds on each second";
      EXPECT_NEAR(curve.points[1].x, 10, 1e-6);
      expect_from_to(curve, 0, 60, 1e-6);
      EXPECT_LT(farthest_y(curve, 0), 1e-3) << joint << ", " << amplitude;
    }
  }
}

// Dots are at 0.5, 3, 10 and 50 Hz, or next to them; the line before them is theory.
inline void expect_transparency(const Promised& shown) {
  const std::string title = "Impedance in free motion / impedance at eta = 1 (lines: theory)";
  int compared = 0;
  for (const Series& dots : shown.panel(title).series) {
    if (dots.style != Series::Style::points) continue;
    const double f = std::stod(dots.label);
    const Series& line = shown.beside(title, dots.label, -1);
    EXPECT_EQ(line.color, dots.color) << dots.label;
    EXPECT_EQ(line.label, "") << dots.label;
    expect_from_to(line, 0.3, 7, 0.35);
    for (const FigurePoint& p : dots.points) {
      const auto after = std::ranges::lower_bound(line.points, p.x, {}, &FigurePoint::x);
      ASSERT_TRUE(after != line.points.begin() && after != line.points.end()) << p.x;
      const double foretold = std::sqrt(after->y * std::prev(after)->y);
      if (f < 15) {
        EXPECT_NEAR(p.y, foretold, 0.25 * foretold) << dots.label << ", eta " << p.x;
      }
      compared += f < 15;
    }
  }
  EXPECT_EQ(compared, 15) << "three frequencies, five etas";
}

// eta follows a sine or jumps while the arm moves: only the proposed coupling makes energy.
inline void expect_lightness(const Promised& shown) {
  const std::string title = "Energy while eta changes between 0.1 and 1";
  const auto& range = shown.panel(title).y_range;
  ASSERT_TRUE(range);
  EXPECT_EQ(shown.panel(title).series.size(), 5u);
  for (const char* label : {"predictive, sine of 0.8 Hz", "square wave, 3 Hz", "20 Hz", "37 Hz"}) {
    const Series& energy = shown.curve(title, label);
    expect_from_to(energy, 0, 2.5, 3e-3);
    EXPECT_LT(energy.points.back().y, 0) << label << ": the arm's damping takes some";
    EXPECT_GT(energy.points.back().y, range->first) << label;
    for (const FigurePoint& p : energy.points) EXPECT_LE(p.y, 1e-3) << label;
  }
  double highest = 0;
  for (const FigurePoint& p : shown.curve(title, "proposed, sine").points) {
    highest = std::max(highest, 1e-3 * p.y);
  }
  const double made =
      shown.check("proposed: highest E_c while eta follows a sine, lower limit [J]");
  EXPECT_TRUE(std::isinf(made) || std::abs(made / highest - 1) < 1e-9) << made << ", " << highest;
}

inline void expect_promised_figure(const std::string& name, const Outcome& outcome) {
  const Promised shown(outcome);
  if (name == "delay") expect_delay(shown);
  if (name == "zwidth") expect_zwidth(shown);
  if (name == "walls") expect_walls(shown);
  if (name == "approaches") expect_approaches(shown);
  if (name == "bodies") expect_bodies(shown);
  if (name == "lightness") expect_lightness(shown);
  if (name == "coordination") {
    for (const char* law : {"standard", "proposed"}) {
      EXPECT_EQ(shown.check(fmt::format("contacts made with the {} coupling", law)), 6) << law;
    }
  }
  if (name == "transparency") expect_transparency(shown);
}

}  // namespace limpid::test
