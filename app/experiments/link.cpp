// Delay between device and proxy: the stiffest wall on which a tap comes to rest, its felt
// stiffness, and the energy given to the hand, under each coupling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/experiments/link_theory.h"
#include "app/experiments/tap_bench.h"
#include "core/dynamics/random.h"

namespace limpid {
namespace {

struct LinkStudy {
  static constexpr int kDelays[] = {0, 1, 2, 3, 4, 5, 7, 10, 20, 50, 100};  // each way [ticks]
  static constexpr double kGrip[] = {300};                                  // [N/m]
  static constexpr double kHold = 6;                                        // [s]
  static constexpr double kGiven = 5e-3;                                    // [J]
  static constexpr double kAtRest = 5e-3;                                   // [m/s]
  static constexpr double kWalls[] = {600, 5000};                           // for the energy [N/m]
  static constexpr unsigned kRandom = 60;        // random links for the tanks
  static constexpr std::pair kDrawn{1e-3, 1e5};  // energies [mJ]
  static constexpr const char* kStandardTint = "#B4B9C3";
};

bool comes_to_rest(const Touch& touch, bool) {
  return touch.energy <= LinkStudy::kGiven && touch.moving <= LinkStudy::kAtRest;
}

// Walls of a law over the delays.
struct LinkCurve {
  std::string label;
  const char* ink;
  TapSetting base;
  double width = 1.8;  // of its line; differs for curves that lie on one another [px]
  std::vector<double> walls = {}, felt = {}, energy = {};  // [N/m, N/m, J]

  // Whether the whole trip is put into the motors' delay: the predictive law has no link.
  bool in_motors() const { return base.kind == CouplingKind::predictive; }
  std::vector<int> delays() const {
    std::vector<int> all;
    for (const int delay : LinkStudy::kDelays) {
      if (!in_motors() || 2 * delay <= kMostDelay) all.push_back(delay);
    }
    return all;
  }
  TapSetting at(int delay) const {
    TapSetting s = base;
    s.hold = LinkStudy::kHold;
    if (in_motors()) {
      s.delay = 2.0 * delay;
    } else {
      s.link = delay;
    }
    return s;
  }
};

enum : std::size_t { kFitted, kStandard, kProposed, kTank, kPredictive };

std::vector<LinkCurve> linked_laws() {
  using enum CouplingKind;
  return {{"standard, gains by condition (3)",
           LinkStudy::kStandardTint,
           {.kind = standard, .fits_link = true},
           7},
          {"standard", kStandardInk, {.kind = standard}, 4},
          {"proposed", kProposedInk, {.kind = proposed}},
          {"tank", kTankInk, {.kind = tank}},
          {"predictive, delayed motors instead", kPredictiveInk, {.kind = predictive}}};
}

void find_walls(TrialRunner& lab, std::vector<LinkCurve>& laws) {
  std::vector<TapSetting> settings;
  for (const LinkCurve& law : laws) {
    for (const int delay : law.delays()) settings.push_back(law.at(delay));
  }
  const std::vector<double> walls =
      stiffest_walls(lab, settings, {LinkStudy::kGrip, comes_to_rest});
  std::size_t i = 0;
  for (LinkCurve& law : laws) {
    for (std::size_t k = 0; k < law.delays().size(); ++k) law.walls.push_back(walls[i++]);
  }
}

// Taps each wall under each law and delay.
template <class WallOf, class Take>
void tap_each_law(TrialRunner& lab, std::vector<LinkCurve>& laws, const WallOf& wall_of,
                  const Take& take) {
  std::vector<TapBench> benches;
  std::vector<std::pair<LinkCurve*, std::size_t>> places;
  std::vector<Trial> trials;
  for (LinkCurve& law : laws) {
    const std::vector<int> delays = law.delays();
    for (std::size_t k = 0; k < delays.size(); ++k) {
      benches.emplace_back(lab.arm(), law.at(delays[k]), wall_of(law, k), LinkStudy::kGrip[0], 1);
      places.emplace_back(&law, k);
      trials.push_back(benches.back().trial());
      trials.back().may_diverge = true;
    }
  }
  std::vector<Touch> touches(trials.size());
  lab.run(trials, [&](std::size_t i, const TrialResult& r) { touches[i] = benches[i].touch(r); });
  for (std::size_t i = 0; i < touches.size(); ++i) {
    take(*places[i].first, places[i].second, touches[i]);
  }
}

void measure_laws(TrialRunner& lab, std::vector<LinkCurve>& laws) {
  tap_each_law(
      lab, laws, [](const LinkCurve& law, std::size_t k) { return law.walls[k]; },
      [](LinkCurve& law, std::size_t k, const Touch& t) {
        law.felt.push_back(law.walls[k] > kSoftest ? t.felt * law.walls[k] : std::nan(""));
      });
  for (LinkCurve& law : laws) law.energy.assign(law.walls.size(), -HUGE_VAL);
  for (const double wall : LinkStudy::kWalls) {
    tap_each_law(
        lab, laws, [&](const LinkCurve&, std::size_t) { return wall; },
        [](LinkCurve& law, std::size_t k, const Touch& t) {
          law.energy[k] = worse(law.energy[k], t.energy);
        });
  }
}

// Highest E_c of the tanks' taps through links with jitter and loss [J].
double through_random_links(TrialRunner& lab) {
  std::vector<TapBench> benches;
  std::vector<Trial> trials;
  Random random(static_cast<unsigned>(lab.seed()) + 1);
  for (unsigned i = 0; i < LinkStudy::kRandom; ++i) {
    TapSetting s{.kind = CouplingKind::tank};
    s.link = static_cast<int>(random.between(0, 100.9));
    s.hold = LinkStudy::kHold / 2;
    benches.emplace_back(lab.arm(), s, random.log_between(kSoftest, kStiffest),
                         random.log_between(100, 3000), 2);
    trials.push_back(benches.back().trial());
    Parameters& p = trials.back().plan.parameters;
    p.link_jitter = static_cast<int>(random.between(0, 50.9));
    p.link_loss = random.between(0, 0.9);
    p.link_seed = static_cast<int>(i);
  }
  std::vector<double> most(trials.size());
  lab.run(trials,
          [&](std::size_t i, const TrialResult& r) { most[i] = benches[i].touch(r).energy; });
  double worst = 0;
  for (const double m : most) worst = worse(worst, m);
  return worst;
}

// Position of a delay on a logarithmic axis that begins with no delay.
double on_axis(int delay) { return delay > 0 ? delay : 0.5; }

FigurePanel over_delays(const std::vector<LinkCurve>& laws, const std::string& title,
                        const std::string& y, std::pair<double, double> range,
                        const std::vector<double> LinkCurve::*values, double scale) {
  FigurePanel panel{
      .title = title, .x_label = "delay each way [ms]", .y_label = y, .log_x = true, .log_y = true};
  panel.x_range = {0.45, 112};
  panel.y_range = {0.5 * range.first, 2 * range.second};  // values at an end stay visible
  panel.x_ticks = {{0.5, "none"}, {1, "1"},   {2, "2"},   {5, "5"},
                   {10, "10"},    {20, "20"}, {50, "50"}, {100, "100"}};
  for (const LinkCurve& law : laws) {
    Series line{law.label, law.ink, Series::Style::line, {}};
    line.width = law.width;
    const std::vector<int> delays = law.delays();
    for (std::size_t k = 0; k < delays.size(); ++k) {
      const double value = scale * (law.*values)[k];
      if (std::isnan(value)) continue;  // nothing was felt
      line.points.push_back({on_axis(delays[k]), std::clamp(value, range.first, range.second)});
    }
    panel.series.push_back(line);
    panel.series.push_back({"", law.ink, Series::Style::points, line.points});
  }
  return panel;
}

std::vector<FigurePanel> draw(const ExperimentArm& on, const std::vector<LinkCurve>& laws,
                              const LinkTheory& theory) {
  FigurePanel walls = over_delays(laws, "The stiffest wall on which a tap comes to rest",
                                  "stiffness [N/m]", {kSoftest, kStiffest}, &LinkCurve::walls, 1);
  Series standard{"standard, theory", kStandardInk, Series::Style::dashed, {}};
  Series proposed{"proposed, theory", kProposedInk, Series::Style::dashed, {}};
  Series named{
      "predictive, wall computed by `limpid analyze`", kPredictiveInk, Series::Style::dashed, {}};
  for (const int delay : LinkStudy::kDelays) {
    standard.points.push_back({on_axis(delay), theory.standard(delay)});
    proposed.points.push_back({on_axis(delay), theory.proposed(delay)});
  }
  const LinkCurve& predictive = laws[kPredictive];
  for (const int delay : predictive.delays()) {
    named.points.push_back(
        {on_axis(delay), std::clamp(named_wall(on, predictive.at(delay)), kSoftest, kStiffest)});
  }
  for (const Series& line : {standard, proposed, named}) walls.series.push_back(line);
  FigurePanel felt = over_delays(laws, "Stiffness felt at the device, at the stiffest wall",
                                 "stiffness [N/m]", {1, 25000}, &LinkCurve::felt, 1);
  FigurePanel energy = over_delays(laws,
                                   fmt::format("Highest energy E_c on walls of {} and {} N/m",
                                               LinkStudy::kWalls[0], LinkStudy::kWalls[1]),
                                   "energy [mJ]", LinkStudy::kDrawn, &LinkCurve::energy, 1e3);
  const double bound = 1e3 * LinkStudy::kGiven;
  energy.series.push_back({"energy in the tanks at the start",
                           kHandInk,
                           Series::Style::dashed,
                           {{0.45, bound}, {112, bound}}});
  return {walls, felt, energy};
}

double highest_of(const std::vector<double>& values) {
  double worst = -HUGE_VAL;
  for (const double v : values) worst = worse(worst, v);
  return worst;
}

// The longest delay at which any wall lets a tap come to rest [ticks].
template <class WallAt>
double longest(const LinkCurve& law, const WallAt& wall_at) {
  double longest = 0;
  const std::vector<int> delays = law.delays();
  for (std::size_t k = 0; k < delays.size(); ++k) {
    if (wall_at(k) > kSoftest) longest = delays[k];
  }
  return longest;
}

// Least ratio of a wall to the expected one, for delays up to `most` [ticks].
template <class Expected>
double least_of(const LinkCurve& law, int most, const Expected& expected) {
  double least = HUGE_VAL;
  const std::vector<int> delays = law.delays();
  for (std::size_t k = 0; k < delays.size() && delays[k] <= most; ++k) {
    least = worse_low(least, law.walls[k] / expected(delays[k]));
  }
  return least;
}

std::vector<Check> judge(TrialRunner& lab, const std::vector<LinkCurve>& laws,
                         const LinkTheory& theory) {
  using S = LinkStudy;
  const LinkCurve& standard = laws[kStandard];
  const double found = longest(standard, [&](std::size_t k) { return standard.walls[k]; });
  const double foretold =
      longest(standard, [&](std::size_t k) { return theory.standard(standard.delays()[k]); });
  return {
      at_most("tank, delays up to 100 ms: highest E_c [J]", highest_of(laws[kTank].energy),
              S::kGiven),
      at_most(
          fmt::format("tank, {} links with delay, jitter and loss: highest E_c [J]", S::kRandom),
          through_random_links(lab), S::kGiven),
      at_most("standard, gains by condition (3): highest E_c [J]", highest_of(laws[kFitted].energy),
              WellRendered::kEnergy),
      at_least("standard, gains by condition (3): stiffest wall [N/m]",
               least_of(laws[kFitted], 100, [](int) { return 1.0; }), kStiffest),
      at_least("tank, delays up to 50 ms: stiffest wall [N/m]",
               least_of(laws[kTank], 50, [](int) { return 1.0; }), kStiffest),
      at_least("standard: longest delay at which a tap comes to rest, divided by the longest delay "
               "of theory",
               found / foretold, 0.75),
      at_most("standard: longest delay at which a tap comes to rest, divided by the longest delay "
              "of theory",
              found / foretold, 1.25),
      at_least("proposed, delays up to 2 ms: stiffest wall, divided by the stiffest wall of theory",
               least_of(laws[kProposed], 2, [&](int d) { return theory.proposed(d); }), 1),
  };
}

}  // namespace

Outcome link(TrialRunner& lab) {
  std::vector<LinkCurve> laws = linked_laws();
  find_walls(lab, laws);
  measure_laws(lab, laws);
  const LinkTheory theory(lab.arm(), LinkStudy::kGrip[0]);
  Outcome outcome;
  outcome.figure.title = "Stiffness of walls with a delay between device and proxy";
  outcome.figure.caption = fmt::format(
      "The tip taps at {} m/s, presses with {} N and holds for {} s; eta = 1. A tap comes to rest "
      "if E_c is at most {} mJ, and the tip has at most {} mm/s at the end. Walls of {} to {} N/m "
      "were tried. Where a curve is at the top, no wall of this range is too stiff. Where a curve "
      "is at the bottom, there is no wall at which the tip comes to rest. Energies outside {} mJ "
      "to {} J are drawn at the axis ends. This link delays all packets by the same time and loses "
      "none. Only the random links of the checks have jitter and loss. Gains by condition (3): the "
      "k_vc, b_vc and b_v that condition (3) of the paper allows for the link and the arm's "
      "damping. The predictive coupling has no link. Instead the motors' torque is delayed by the "
      "delays of both ways together. The law knows this delay up to 20 ms. Theory: for the "
      "standard coupling, from the poles of hand, device, spring and wall; for the proposed "
      "coupling, from the damping divided by the lag of the contact.",
      TapBench::kSpeed, TapSetting{}.press, LinkStudy::kHold, 1e3 * LinkStudy::kGiven,
      1e3 * LinkStudy::kAtRest, kSoftest, kStiffest, LinkStudy::kDrawn.first,
      1e-3 * LinkStudy::kDrawn.second);
  outcome.figure.columns = 2;
  outcome.figure.panels = draw(lab.arm(), laws, theory);
  outcome.checks = judge(lab, laws, theory);
  return outcome;
}

}  // namespace limpid
