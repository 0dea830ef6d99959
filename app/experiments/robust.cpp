// Until where each law's promise holds on a device that is unlike its model: motors, transmission,
// encoders and inertia that no law knows, on an ideal arm and on one as real as a Touch.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/base/folders.h"
#include "app/experiments/law_bench.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "core/dynamics/arm.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

constexpr double kMayGive = 5e-3;    // energy that a law may give [J]
constexpr double kMayShake = 0.1;    // rms force above 20 Hz, of the press [-]
constexpr double kSoftestTap = 300;  // walls that are named softer are tapped with this [N/m]

constexpr std::array kRobustArms{BenchArm{"ideal", "omni.urdf"}, BenchArm{"Touch", "touch.urdf"}};
constexpr std::array kLines{Series::Style::dashed, Series::Style::line};  // of the arms

// A law and whether it promises to give no more than kMayGive.
struct RobustLaw {
  CouplingKind kind;
  bool promises = true;
};
constexpr std::array kRobustLaws{RobustLaw{CouplingKind::standard},
                                 RobustLaw{CouplingKind::tank},
                                 RobustLaw{CouplingKind::eba},
                                 RobustLaw{CouplingKind::predictive},
                                 RobustLaw{CouplingKind::proposed, false},
                                 RobustLaw{CouplingKind::direct, false}};

// A way of being unlike the model, from mild to severe.
struct Imperfection {
  const char* title;
  const char* unit;  // of the levels as they are shown
  double scale;      // of the levels to it
  double Parameters::*field;
  std::vector<double> levels;
  std::size_t promised;  // so many levels are judged; the others are measured
};

const std::vector<Imperfection>& imperfections() {
  using P = Parameters;
  static const std::vector<Imperfection> all{
      {"motors give more", "times the command", 1, &P::torque_scale, {1.1, 1.2, 1.3, 1.5, 2}, 4},
      {"motors give less", "times the command", 1, &P::torque_scale, {0.9, 0.8, 0.7, 0.5}, 4},
      {"current loop", "Hz", 1, &P::current_loop, {2000, 1000, 500, 300, 200, 100, 50}, 5},
      {"resonance", "Hz", 1, &P::resonance, {1000, 700, 500, 300, 200, 150, 100, 70, 50, 30}, 3},
      {"cogging", "mN m", 1e3, &P::cogging, {5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2}, 6},
      {"unknown friction", "mN m", 1e3, &P::unknown_friction, {2e-3, 5e-3, 1e-2, 2e-2, 5e-2}, 5},
      {"eccentric encoders", "mrad", 1e3, &P::eccentricity, {5e-4, 1e-3, 2e-3, 5e-3, 1e-2}, 5},
      {"wrong zero", "mrad", 1e3, &P::zero_error, {1e-2, 2e-2, 5e-2, 0.1, 0.2}, 5},
      {"model's inertia too large",
       "times the true inertia",
       1,
       &P::inertia_error,
       {1.25, 1.5, 2, 3},
       4},
      {"model's inertia too small",
       "times the true inertia",
       1,
       &P::inertia_error,
       {0.8, 0.67, 0.5, 0.33},
       3}};
  return all;
}
constexpr std::size_t kLoop = 2, kResonance = 3;  // places in imperfections()

// An arm under a law, with a way of being unlike its model. Level 0: none of it.
struct RobustCase {
  std::size_t arm, law, way, level;

  const RobustLaw& of_law() const { return kRobustLaws[law]; }
  const Imperfection& of_way() const { return imperfections()[way]; }
  Parameters parameters(const ArmDescription& description) const {
    Parameters p = fitted_with_readings(description);
    p.kind = of_law().kind;
    p.delay_most = p.delay + 1;  // as for a device that was identified
    return p;
  }
};

// Worst result of a case in all hands.
struct RobustCame {
  double given = 0;             // most [J]
  double off = 0, shaking = 0;  // felt stiffness off the set one; rms force, of the press [-]

  bool kept() const { return given <= kMayGive; }
  bool well() const { return kept() && off <= kFeltOff && shaking <= kMayShake; }
};

// A wall and its taps in every hand.
struct RobustTap {
  RobustCase of;
  double wall;  // [N/m]
};

class RobustBench {
 public:
  explicit RobustBench(TrialRunner& lab) : lab_(lab) {
    for (const BenchArm& arm : kRobustArms) arms_.push_back(arm.arm());
  }

  // The wall that `limpid analyze` computes for the case without any imperfection [N/m].
  double named(const RobustCase& of) const {
    const ArmDescription& arm = arms_[of.arm];
    const TipLimits limits = tip_limits(arm, rest_pose(arm), of.parameters(arm), {});
    return std::max(kSoftestTap, limits.wall(of.of_law().kind).stiffness);
  }
  std::vector<RobustCame> tap(const std::vector<RobustTap>& taps);
  // Finds for each case the stiffest wall that is rendered well and gives at most kMayGive [N/m];
  // kLeastWall if none is.
  std::vector<double> stiffest(const std::vector<RobustCase>& cases);

 private:
  struct Plan {
    Trial trial;
    WallTap tap;
  };
  Plan plan(const RobustTap& tap, const BenchHand& hand) const;

  TrialRunner& lab_;
  std::vector<ArmDescription> arms_;
};

// The wall stands where the encoders see it.
RobustBench::Plan RobustBench::plan(const RobustTap& tap, const BenchHand& hand) const {
  const ArmDescription& arm = arms_[tap.of.arm];
  Parameters p = tap.of.parameters(arm);
  const TapPlace place = tap_place(arm, rest_pose(arm), p);
  hand.holds(p);
  if (tap.of.level > 0) p.*tap.of.of_way().field = tap.of.of_way().levels[tap.of.level - 1];
  Plan plan{{}, {.wall = tap.wall, .press = bearable_press(arm, place, p, kHardest)}};
  plan.trial.plan = tap_plan(arm, place, plan.tap, p);
  if (p.zero_error != 0) {  // the proxy begins there, too
    TapPlace seen = place;
    seen.x.array() += p.zero_error;
    seen.point = Arm<kAnyDof>(arm).tip_at(seen.x);
    plan.trial.plan.document = tap_plan(arm, seen, plan.tap, p).document;
    plan.trial.plan.start->x2.array() += p.zero_error;
  }
  plan.trial.keep = false;
  plan.trial.may_diverge = true;
  return plan;
}

std::vector<RobustCame> RobustBench::tap(const std::vector<RobustTap>& taps) {
  constexpr std::size_t kHandsTried = kHands.size();
  std::vector<Trial> trials;
  std::vector<WallTap> ways;
  for (const RobustTap& tap : taps) {
    for (const BenchHand& hand : kHands) {
      Plan made = plan(tap, hand);
      trials.push_back(std::move(made.trial));
      ways.push_back(made.tap);
    }
  }
  std::vector<RobustCame> each(trials.size());
  lab_.run(trials, [&](std::size_t i, const TrialResult& r) {
    if (r.end.diverged) {
      each[i] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
      return;
    }
    WallMeter meter = tap_meter(trials[i].plan, ways[i]);
    const RowLayout& layout = r.session.layout;
    std::vector<double> seen(static_cast<std::size_t>(layout.stride()));
    for (std::size_t k = 0; k < r.session.size(); ++k) {
      each[i].given = worse(each[i].given, r.session.at(k, Column::energy_port)[0]);
      std::ranges::copy(r.session.row(k), seen.begin());  // the depth counts as encoders see it
      std::ranges::copy(layout.in(std::span<const double>(seen), Column::measured_position),
                        layout.in(std::span(seen), Column::device_position).begin());
      meter.add(layout, seen);
    }
    each[i].off = std::abs(meter.felt() - 1);
    each[i].shaking = meter.rattle() / ways[i].press;
  });
  std::vector<RobustCame> came(taps.size());
  for (std::size_t i = 0; i < each.size(); ++i) {
    RobustCame& worst = came[i / kHandsTried];
    worst.given = worse(worst.given, each[i].given);
    if (i % kHandsTried >= kDamped) continue;
    worst.off = worse(worst.off, each[i].off);
    worst.shaking = worse(worst.shaking, each[i].shaking);
  }
  return came;
}

std::vector<double> RobustBench::stiffest(const std::vector<RobustCase>& cases) {
  return stiffest_of(cases.size(), [&](const std::vector<double>& walls) {
    std::vector<RobustTap> taps;
    for (std::size_t i = 0; i < cases.size(); ++i) taps.push_back({cases[i], walls[i]});
    std::vector<bool> well;
    for (const RobustCame& came : tap(taps)) well.push_back(came.well());
    return well;
  });
}

// Every case that is tapped, in order, and what became of it.
struct Robustness {
  std::vector<RobustCase> cases;
  std::vector<RobustCame> came;

  template <class Which>
  double most_given(const Which& which) const {
    double most = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (which(cases[i])) most = worse(most, came[i].given);
    }
    return most;
  }
  // The last level up to which nothing more than kMayGive is given; 0 if none is.
  std::size_t kept_to(std::size_t arm, std::size_t law, std::size_t way) const {
    std::size_t last = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const RobustCase& c = cases[i];
      if (c.arm != arm || c.law != law || c.way != way || c.level == 0) continue;
      if (!came[i].kept()) return last;
      last = c.level;
    }
    return last;
  }
};

Robustness tap_everything(RobustBench& bench) {
  Robustness all;
  std::vector<RobustTap> taps;
  for (std::size_t a = 0; a < kRobustArms.size(); ++a) {
    for (std::size_t l = 0; l < kRobustLaws.size(); ++l) {
      const double wall = bench.named({a, l, 0, 0});
      for (std::size_t w = 0; w < imperfections().size(); ++w) {
        // Without any imperfection all ways are one.
        for (std::size_t level = w == 0 ? 0 : 1; level <= imperfections()[w].levels.size();
             ++level) {
          all.cases.push_back({a, l, w, level});
          taps.push_back({all.cases.back(), wall});
        }
      }
    }
  }
  all.came = bench.tap(taps);
  return all;
}

std::string curve_label(const RobustCase& c) {
  return fmt::format("{}, {}", info(c.of_law().kind).key, kRobustArms[c.arm].name);
}

FigurePanel panel_of(std::size_t way, const std::string& title, const std::string& y) {
  const Imperfection& of = imperfections()[way];
  FigurePanel panel{.title = fmt::format("{}, against the {}", title, of.title),
                    .x_label = fmt::format("{} [{}]", of.title, of.unit),
                    .y_label = y,
                    .log_x = true,
                    .log_y = true};
  const auto [least, most] = std::ranges::minmax(of.levels);
  panel.x_range = {0.8 * of.scale * least, 1.25 * of.scale * most};
  return panel;
}

// Adds a curve of each law and arm to a panel: `value` of each case of this way.
template <class Value>
void add_curves(FigurePanel& panel, const std::vector<RobustCase>& cases, std::size_t way,
                const Value& value) {
  std::size_t arm = kRobustArms.size(), law = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const RobustCase& c = cases[i];
    if (c.way != way || c.level == 0) continue;
    if (c.arm != arm || c.law != law) {
      arm = c.arm;
      law = c.law;
      panel.series.push_back({curve_label(c), bench_law(c.of_law().kind).ink, kLines[c.arm], {}});
    }
    const Imperfection& of = c.of_way();
    panel.series.back().points.push_back({of.scale * of.levels[c.level - 1], value(i)});
  }
}

FigurePanel given_panel(const Robustness& all, std::size_t way) {
  constexpr double kLeast = 1e-3, kMost = 1e4;  // [mJ]
  FigurePanel panel =
      panel_of(way, "Energy given at the computed wall", "largest energy given to the hand [mJ]");
  panel.y_range = {0.5 * kLeast, 2 * kMost};
  add_curves(panel, all.cases, way,
             [&](std::size_t i) { return std::clamp(1e3 * all.came[i].given, kLeast, kMost); });
  return panel;
}

// Searches the stiffest walls over a way, under the laws that render walls on the device.
FigurePanel stiffest_panel(RobustBench& bench, std::size_t way) {
  std::vector<RobustCase> cases;
  for (std::size_t a = 0; a < kRobustArms.size(); ++a) {
    for (std::size_t l = 0; l < kRobustLaws.size(); ++l) {
      const CouplingKind kind = kRobustLaws[l].kind;
      if (kind != CouplingKind::predictive && kind != CouplingKind::direct) continue;
      for (std::size_t level = 1; level <= imperfections()[way].levels.size(); ++level) {
        cases.push_back({a, l, way, level});
      }
    }
  }
  const std::vector<double> walls = bench.stiffest(cases);
  FigurePanel panel =
      panel_of(way, "The stiffest wall that is rendered well", "stiffest wall [N/m]");
  panel.y_range = {0.8 * kLeastWall, 1.5 * kMostWall};
  add_curves(panel, cases, way, [&](std::size_t i) { return walls[i]; });
  return panel;
}

std::string level_text(const Imperfection& way, std::size_t level) {
  return fmt::format("{:g} {}", way.scale * way.levels[level - 1], way.unit);
}

// Judges each way over all arms and laws that promise something, as far as it is promised.
void judge_promised(const Robustness& all, std::vector<Check>& checks) {
  for (std::size_t w = 0; w < imperfections().size(); ++w) {
    const Imperfection& way = imperfections()[w];
    const auto promised = [&](const RobustCase& c) {
      return (c.way == w || c.level == 0) && c.level <= way.promised && c.of_law().promises;
    };
    checks.push_back(at_most(fmt::format("{}, at worst {}: largest energy given [J]", way.title,
                                         level_text(way, way.promised)),
                             all.most_given(promised), kMayGive));
  }
}

// Says to where a promise was kept, where that is not to the end.
void tell_ends(const Robustness& all, std::vector<Check>& checks) {
  for (std::size_t w = 0; w < imperfections().size(); ++w) {
    const Imperfection& way = imperfections()[w];
    for (std::size_t a = 0; a < kRobustArms.size(); ++a) {
      for (std::size_t l = 0; l < kRobustLaws.size(); ++l) {
        const std::size_t last = all.kept_to(a, l, w);
        if (!kRobustLaws[l].promises || last == way.levels.size()) continue;
        Check end = at_most(
            fmt::format("{}, {}, {}: worst value at which at most 5 mJ are given [{}]",
                        kRobustArms[a].name, info(kRobustLaws[l].kind).key, way.title, way.unit),
            last > 0 ? way.scale * way.levels[last - 1] : std::nan(""), 0);
        end.unjudged = "No theory gives this limit.";
        checks.push_back(end);
      }
    }
  }
}

}  // namespace

Outcome robust(TrialRunner& lab) {
  RobustBench bench(lab);
  const Robustness all = tap_everything(bench);
  Outcome outcome;
  outcome.figure.title = "Promises on a device that differs from its model";
  outcome.figure.caption = fmt::format(
      "The tip taps, at {} m/s, the wall that `limpid analyze` computes for each law and arm (at "
      "least {} N/m). Then the hand presses with {} N, or with half of the motors' limit if that "
      "is smaller. Grips are 300 and 3,000 N/m, with 2 N s/m and without damping. The gains are "
      "fitted to each arm; eta = 1, tick 1 ms. The laws are told the known delay plus one tick. "
      "Dashed lines: the built-in arm, ideal. Solid lines: a Touch with encoder steps of 4.19e-4 "
      "rad, friction and 1 ms of delay. The energy given is the largest energy of all hands; the "
      "axis shows 1e-3 mJ to 10 J. A wall is rendered well if three conditions hold. In both grips "
      "with damping the stiffness felt differs from the stiffness set by at most {} %, and the rms "
      "force above {} Hz is at most {} times the pressing force. In all grips the hand is given at "
      "most 5 mJ. Walls from {} to {} N/m were tried.",
      WallTap::kSpeed, kSoftestTap, kHardest, 100 * kFeltOff, WallTap::kFast, kMayShake, kLeastWall,
      kMostWall);
  outcome.figure.columns = 2;
  for (const std::size_t way : {kLoop, kResonance}) {
    outcome.figure.panels.push_back(given_panel(all, way));
    outcome.figure.panels.push_back(stiffest_panel(bench, way));
  }
  judge_promised(all, outcome.checks);
  tell_ends(all, outcome.checks);
  return outcome;
}

}  // namespace limpid
