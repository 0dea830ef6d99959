// The field's laws beside Limpid's: stiffness felt, energy given and trembling of the same taps, on
// an ideal arm and on arms as real as devices are.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "app/base/folders.h"
#include "app/experiments/experiment.h"
#include "app/experiments/law_bench.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "app/run/wall_tap.h"
#include "devices/files/urdf_file.h"

namespace limpid {
namespace {

constexpr double kHeavier = 7, kPapersStep = 4.19e-4;  // of the built-in arm [-]; encoder [rad]

constexpr std::array kArms{BenchArm{"built-in, ideal", "omni.urdf"},
                           BenchArm{"Touch", "touch.urdf"}, BenchArm{"omega", "omega.urdf"},
                           BenchArm{"Inverse3", "inverse3.urdf"}};

ArmUnderLaw arm_under(const BenchArm& bench, CouplingKind kind) {
  ArmUnderLaw at{bench.arm(), {}};
  at.parameters = fitted_with_readings(at.arm);
  at.parameters.kind = kind;
  return at;
}

struct Tap {
  BenchArm arm;
  CouplingKind kind;
  BenchHand hand;
  double wall;        // [N/m]
  int link = 0;       // delay between device and proxy, each way [ticks]
  double hold = 0.5;  // [s]

  ArmTap on_bench() const {
    ArmTap tap{arm_under(arm, kind), wall, hold};
    tap.at.parameters.link_delay = link;
    hand.holds(tap.at.parameters);
    return tap;
  }
};

std::vector<Came> tap_each(TrialRunner& lab, const std::vector<Tap>& taps) {
  std::vector<ArmTap> on_bench;
  for (const Tap& tap : taps) on_bench.push_back(tap.on_bench());
  return tap_arms(lab, on_bench);
}

struct Searched {
  BenchArm arm;
  CouplingKind kind;
};

std::vector<double> stiffest(TrialRunner& lab, const std::vector<Searched>& all) {
  std::vector<ArmUnderLaw> on_bench;
  for (const Searched& each : all) on_bench.push_back(arm_under(each.arm, each.kind));
  return stiffest_quiet_walls(lab, on_bench);
}

TipAlong tip_of(const BenchArm& bench) {
  const ArmDescription arm = bench.arm();
  const ArmAt at = arm_at(arm, rest_pose(arm));
  const Eigen::VectorXd b = device_damping(arm, {});
  return tip_along(at.J, at.M, b, least_damped(at.J, b));
}

// Taps of every law on every arm in every hand at the same wall, and the stiffest walls.
struct Compared {
  std::vector<Tap> taps;
  std::vector<Came> came;
  std::vector<double> walls;  // arm by arm, law by law [N/m]

  template <class Which, class Value>
  double most(const Which& which, const Value& value) const {
    double worst = 0;
    for (std::size_t i = 0; i < taps.size(); ++i) {
      if (which(taps[i])) worst = worse(worst, value(came[i]));
    }
    return worst;
  }
};

Compared compare(TrialRunner& lab) {
  Compared all;
  std::vector<Searched> searched;
  for (const BenchArm& arm : kArms) {
    for (const BenchLaw& law : kBenchLaws) {
      searched.push_back({arm, law.kind});
      for (const BenchHand& hand : kHands) all.taps.push_back({arm, law.kind, hand, kCommonWall});
    }
  }
  all.came = tap_each(lab, all.taps);
  all.walls = stiffest(lab, searched);
  return all;
}

constexpr std::array kLateTicks{0, 1, 2, 3};  // [ticks]
constexpr std::array kOverDelay{CouplingKind::proposed, CouplingKind::predictive,
                                CouplingKind::direct, CouplingKind::popc};

const char* ink_of(CouplingKind kind) { return bench_law(kind).ink; }

// Laws through a link, pressed for long in a hand that damps and in one that does not.
constexpr std::array kLinks{0, 1, 2, 5, 10, 20, 50};  // each way [ticks]
constexpr std::array kLinked{BenchLaw{CouplingKind::tank, kTankInk, "1", 4},
                             BenchLaw{CouplingKind::wave, kFamilyInk[0], "(6,6)", 9},
                             BenchLaw{CouplingKind::tdpn, kFamilyInk[2], "(8,3,2,3)", 13}};
constexpr double kFarWall = 5000, kLong = 3;  // [N/m], [s]

struct Linked {
  std::vector<Came> came;  // law by law, link by link, hand by hand

  static constexpr std::array kHeld{BenchHand{300, 2}, BenchHand{300, 0}};
  const Came& at(std::size_t law, std::size_t link, std::size_t hand) const {
    return came[(law * kLinks.size() + link) * kHeld.size() + hand];
  }
};

Linked press_through_links(TrialRunner& lab) {
  std::vector<Tap> taps;
  for (const BenchLaw& law : kLinked) {
    for (const int link : kLinks) {
      for (const BenchHand& hand : Linked::kHeld) {
        taps.push_back({kArms[0], law.kind, hand, kFarWall, link, kLong});
      }
    }
  }
  return {tap_each(lab, taps)};
}

// Stiffness felt through spring and line of `wave` [N/m].
double felt_through(int link) {
  const Parameters p;
  const double line = line_at_tip(tip_of(kArms[0]), p.k_vc, p.line(), (link + 0.5) * p.tick);
  return 1 / (1 / kFarWall + 1 / line);
}

FigurePanel link_panel(const Linked& all) {
  FigurePanel panel{.title = "Built-in arm, through a link: a wall of 5000 N/m",
                    .x_label = "delay each way [ms]",
                    .y_label = "stiffness felt [N/m]",
                    .log_y = true,
                    .x_range = std::pair(-1.0, 51.0),
                    .y_range = std::pair(2.0, 400.0)};
  for (std::size_t l = 0; l < kLinked.size(); ++l) {
    Series line = kLinked[l].line();
    for (std::size_t i = 0; i < kLinks.size(); ++i) {
      const double felt = kFarWall * all.at(l, i, 0).felt;
      if (felt > 0) line.points.push_back({double(kLinks[i]), felt});
    }
    panel.series.push_back(line);
  }
  Series theory{
      "wave: 1/(1/K + 1/k_vc + (link + T/2)/b)", kFamilyInk[0], Series::Style::dashed, {}};
  for (int link = 0; link <= 50; ++link) {
    theory.points.push_back({double(link), felt_through(link)});
  }
  panel.series.push_back(theory);
  return panel;
}

void judge_links(const Linked& all, std::vector<Check>& checks) {
  constexpr std::size_t kWave = 1, kTdpn = 2;
  double total = 0, off = 0, port = 0, stiffer = HUGE_VAL;
  for (std::size_t i = 0; i < kLinks.size(); ++i) {
    for (std::size_t hand = 0; hand < Linked::kHeld.size(); ++hand) {
      total = worse(total, all.at(kWave, i, hand).total);
      port = worse(port, all.at(kTdpn, i, hand).port);
    }
    const double felt = kFarWall * all.at(kWave, i, 0).felt;
    off = worse(off, std::abs(felt / felt_through(kLinks[i]) - 1));
    if (kLinks[i] < 5) continue;
    stiffer = worse_low(stiffer, kFarWall * all.at(kTdpn, i, 0).felt / felt);
  }
  checks.push_back(at_most("wave, links up to 50 ms: highest E_c [J]", total, 1e-9));
  checks.push_back(
      at_most("wave, links up to 50 ms: relative deviation of the stiffness felt from the "
              "stiffness of spring and line in series",
              off, 0.06));
  checks.push_back(
      at_most("tdpn, links up to 50 ms: largest energy given to the hand [J]", port, 5e-3));
  checks.push_back(
      at_least("tdpn, links of 5 to 50 ms: stiffness felt, divided by the stiffness felt with wave",
               stiffer, 1));
}

FigurePanel energy_panel(const Compared& all, const BenchArm& arm) {
  std::vector<LawCame> of_arm;
  for (std::size_t i = 0; i < all.taps.size(); ++i) {
    if (std::string_view(all.taps[i].arm.name) != arm.name) continue;
    of_arm.push_back({all.taps[i].kind, all.came[i]});
  }
  return energy_panel(fmt::format("{}: a wall of {} N/m", arm.name, kCommonWall), of_arm);
}

FigurePanel delay_panel(const std::vector<double>& walls) {
  FigurePanel panel{.title = "Built-in arm: stiffest wall against the device's delay",
                    .x_label = "delay [ms]",
                    .y_label = "stiffest wall [N/m]",
                    .log_y = true,
                    .x_range = std::pair(-0.2, 3.2),
                    .y_range = std::pair(0.8 * kLeastWall, 1.5 * kMostWall)};
  std::size_t at = 0;
  for (const CouplingKind kind : kOverDelay) {
    Series line = bench_law(kind).line();
    for (const int delay : kLateTicks) line.points.push_back({double(delay), walls[at++]});
    panel.series.push_back(line);
  }
  const TipAlong tip = tip_of(kArms[0]);
  Series theory{
      "direct: (b_d + b_h)/(T/2 + delay)", ink_of(CouplingKind::direct), Series::Style::dashed, {}};
  Series bounded{"eba: 2 b_d/(T + delay)", ink_of(CouplingKind::eba), Series::Style::dashed, {}};
  for (double ms = 0; ms <= 3.001; ms += 0.1) {
    const WallSetting s{.hand_damping = kHands[0].damping, .delay = 1e-3 * ms};
    theory.points.push_back({ms, direct_wall(tip, s)});
    bounded.points.push_back({ms, bounded_wall(tip, s)});
  }
  panel.series.push_back(theory);
  panel.series.push_back(bounded);
  return panel;
}

FigurePanel arms_panel(const Compared& all) {
  FigurePanel panel{.title = "The stiffest wall that is rendered well",
                    .x_label = "",
                    .y_label = "stiffest wall [N/m]",
                    .log_y = true,
                    .x_range = std::pair(-0.5, double(kArms.size()) - 0.5),
                    .y_range = std::pair(0.8 * kLeastWall, 1.5 * kMostWall)};
  for (std::size_t a = 0; a < kArms.size(); ++a) panel.x_ticks.emplace_back(a, kArms[a].name);
  for (std::size_t l = 0; l < kBenchLaws.size(); ++l) {
    Series points = kBenchLaws[l].points();
    for (std::size_t a = 0; a < kArms.size(); ++a) {
      const double aside = 0.08 * (double(l) - double(kBenchLaws.size() - 1) / 2);
      points.points.push_back({double(a) + aside, all.walls[a * kBenchLaws.size() + l]});
    }
    panel.series.push_back(points);
  }
  return panel;
}

// Direct walls against (b_d + b_h)/(T/2 + delay), where the search found the end of quiet.
void judge_direct(const std::vector<double>& walls, std::vector<Check>& checks) {
  const TipAlong tip = tip_of(kArms[0]);
  const std::size_t first =
      kLateTicks.size() *
      static_cast<std::size_t>(std::ranges::find(kOverDelay, CouplingKind::direct) -
                               kOverDelay.begin());
  for (const int delay : {0, 1, 3}) {
    const WallSetting s{.hand_damping = kHands[0].damping, .delay = 1e-3 * delay};
    const double ratio = walls[first + static_cast<std::size_t>(delay)] / direct_wall(tip, s);
    const std::string what = fmt::format(
        "direct, delay of {} ms: stiffest wall, divided by (b_d + b_h)/(T/2 + delay)", delay);
    std::ranges::copy(by_direct_theory(what, ratio), std::back_inserter(checks));
  }
}

void judge_promises(const Compared& all, std::vector<Check>& checks) {
  const auto given = [](const Came& came) { return came.port; };
  const auto of = [](CouplingKind kind) {
    return [kind](const Tap& tap) { return tap.kind == kind; };
  };
  const auto exact = [](const Tap& tap) {
    return tap.kind == CouplingKind::eba && tap.arm.arm().encoder_step == 0;
  };
  checks.push_back(at_most("eba, exact encoders: largest energy given to the hand [J]",
                           all.most(exact, given), 1e-9));
  checks.push_back(at_most("eba, all arms: largest energy given to the hand [J]",
                           all.most(of(CouplingKind::eba), given), 1e-3));
  for (const CouplingKind kind : {CouplingKind::predictive, CouplingKind::tank}) {
    checks.push_back(
        at_most(fmt::format("{}, all arms: largest energy given to the hand [J]", name(kind)),
                all.most(of(kind), given), 5e-3));
  }
}

// On an arm as heavy as those of the papers, with exact encoders and with the Omni's.
void judge_observer(TrialRunner& lab, std::vector<Check>& checks) {
  const BenchArm heavy{"built-in, 7 times as heavy", "omni.urdf", kHeavier};
  BenchArm stepped = heavy;
  stepped.step = kPapersStep;
  std::vector<Tap> taps;
  for (const double wall : {500.0, 2000.0, 10'000.0}) {
    for (const BenchHand& hand : kHands) taps.push_back({heavy, CouplingKind::popc, hand, wall});
  }
  double most = 0;
  for (const Came& came : tap_each(lab, taps)) most = worse(most, came.port);
  checks.push_back(at_most(
      "popc, 70 g, exact encoders, walls up to 10,000 N/m: largest energy given to the hand [J]",
      most, 1e-3));
  const std::vector<double> walls = stiffest(lab, {{heavy, CouplingKind::popc},
                                                   {heavy, CouplingKind::direct},
                                                   {stepped, CouplingKind::popc},
                                                   {stepped, CouplingKind::direct}});
  checks.push_back(
      at_least("popc, 70 g, exact encoders: stiffest wall, divided by the stiffest wall of direct",
               walls[0] / walls[1], 3));
  checks.push_back(at_most(
      "popc, 70 g, steps of 4.19e-4 rad: stiffest wall, divided by the stiffest wall of direct",
      walls[2] / walls[3], 1.5));
}

}  // namespace

Outcome approaches(TrialRunner& lab) {
  const Compared all = compare(lab);
  std::vector<Searched> late;
  for (const CouplingKind kind : kOverDelay) {
    for (const int delay : kLateTicks) {
      BenchArm arm = kArms[0];
      arm.late = delay * Parameters{}.tick;
      late.push_back({arm, kind});
    }
  }
  const std::vector<double> over_delay = stiffest(lab, late);
  Outcome outcome;
  outcome.figure.title = "Stability approaches compared";
  outcome.figure.caption = fmt::format(
      "The tip taps a wall at {} m/s. Then the hand presses with {} N, or with half of the motors' "
      "limit if that is smaller, and holds. Grips are 300 and 3,000 N/m, with 2 N s/m and without "
      "damping. The gains are fitted to each arm and its delay; eta = 1, tick 1 ms. Touch: encoder "
      "steps of 4.19e-4 rad, friction, 1 ms of delay. omega: position steps of 0.01 mm. Inverse3: "
      "position steps of 0.01 mm, 1 ms of delay. The laws know the delays. The energy is the "
      "largest energy that the hand was given; the axis shows 1e-4 mJ to 1 J. At the stiffest wall "
      "the stiffness felt differs from the stiffness set by at most {} %, and the rms speed of the "
      "tip above 20 Hz is at most {} mm/s, in both grips with damping. Walls from {} to {} N/m "
      "were tried. Through a link the tip is held for 3 s in a grip of 300 N/m, with the paper's "
      "gains.",
      WallTap::kSpeed, kHardest, 100 * kFeltOff, 1e3 * kQuiet, kLeastWall, kMostWall);
  outcome.figure.columns = 2;
  for (const BenchArm& arm : kArms) outcome.figure.panels.push_back(energy_panel(all, arm));
  outcome.figure.panels.push_back(arms_panel(all));
  outcome.figure.panels.push_back(delay_panel(over_delay));
  const Linked linked = press_through_links(lab);
  outcome.figure.panels.push_back(link_panel(linked));
  judge_direct(over_delay, outcome.checks);
  judge_promises(all, outcome.checks);
  judge_observer(lab, outcome.checks);
  judge_links(linked, outcome.checks);
  return outcome;
}

}  // namespace limpid
