// The report of what an arm can render, against closed forms.
#include "app/experiments/characterize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/base/folders.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "devices/files/urdf_file.h"
#include "tests/app/experiments/cells_of_page.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Characterized built_in(int delay) {
  Characterized subject;
  subject.at.arm = read_urdf(default_device());
  subject.at.parameters = fitted(subject.at.arm);
  subject.at.parameters.device_delay = subject.at.parameters.delay = delay;
  subject.name = "the built-in arm";
  subject.numbers = {{"delay", "delay", "ms", 1.0 * delay, "a test said so", true}};
  return subject;
}

TipAlong tip_of(const ArmDescription& arm) {
  const ArmAt at = arm_at(arm, rest_pose(arm));
  const Eigen::VectorXd b = device_damping(arm, {});
  return tip_along(at.J, at.M, b, least_damped(at.J, b));
}

const LawRendered& of(const Characterization& found, CouplingKind kind) {
  return *std::ranges::find(found.laws, kind, &LawRendered::kind);
}

struct ACharacterization : testing::Test {
  Characterization of_built_in(int delay) {
    TrialRunner::Options options;
    options.dir = dir / ".";
    TrialRunner lab("characterize", options);
    return characterize(lab, built_in(delay));
  }

  test::TempDir dir;
};

TEST_F(ACharacterization, FindsTheWallsOfTheory) {
  const TipAlong tip = tip_of(built_in(0).at.arm);
  for (const int delay : {0, 1, 3}) {
    const Characterization found = of_built_in(delay);
    const WallSetting s{.hand_damping = kHands[0].damping, .delay = 1e-3 * delay};
    const double direct = of(found, CouplingKind::direct).wall / direct_wall(tip, s);
    EXPECT_GT(direct, 0.85) << delay;
    EXPECT_LT(direct, 1.25) << delay;
    EXPECT_LE(of(found, CouplingKind::eba).most_given(), 1e-9) << delay;
    EXPECT_TRUE(found.outcome.passed()) << delay;
    for (const Check& check : found.outcome.checks) EXPECT_TRUE(check.passed) << check.what;
  }
}

// Without friction and encoder steps a device's own mass and damping are felt under laws that
// command nothing in free motion.
TEST_F(ACharacterization, FindsMassAndDampingOfTheTip) {
  const TipAlong tip = tip_of(built_in(0).at.arm);
  const Characterization found = of_built_in(0);
  for (const CouplingKind kind : {CouplingKind::direct, CouplingKind::popc}) {
    const LawRendered& law = of(found, kind);
    ASSERT_EQ(law.free.size(), std::size(kFreeTold));
    for (const FeltMotion& felt : law.free) {
      EXPECT_NEAR(felt.inertia, tip.mass, 0.06 * tip.mass) << felt.f;
      EXPECT_NEAR(felt.damping, tip.damping, 0.06 * tip.damping) << felt.f;
    }
  }
}

void expect_dots_at(const Series& dots, const std::vector<double>& ys) {
  ASSERT_EQ(dots.points.size(), ys.size()) << dots.label;
  for (std::size_t i = 0; i < ys.size(); ++i) {
    EXPECT_EQ(dots.points[i].x, static_cast<double>(i)) << dots.label;
    EXPECT_NEAR(dots.points[i].y, ys[i], 1e-9 * ys[i]) << dots.label;
  }
}

// Panels of walls, energy, mass and damping hold what the laws do.
void expect_drawn(const Characterization& found) {
  const auto& panels = found.outcome.figure.panels;
  ASSERT_EQ(panels.size(), 4u);
  std::vector<double> named, measured;
  for (const LawRendered& law : found.laws) {
    measured.push_back(law.wall);
    named.push_back(std::min(20000.0, std::max(50.0, law.named)));
  }
  expect_dots_at(panels[0].series.at(0), named);
  expect_dots_at(panels[0].series.at(1), measured);
  EXPECT_THAT(panels[0].series[0].label, HasSubstr("limpid analyze"));
  for (std::size_t i = 0; i < found.laws.size(); ++i) {
    const LawRendered& law = found.laws[i];
    const std::string key = info(law.kind).key;
    EXPECT_EQ(panels[0].x_ticks.at(i), std::pair(static_cast<double>(i), key));
    const Series &taps = panels[1].series.at(i), &mass = panels[2].series.at(i),
                 &damping = panels[3].series.at(i);
    for (const Series* of : {&taps, &mass, &damping}) {
      EXPECT_EQ(of->label, key);
      EXPECT_EQ(of->color, bench_law(law.kind).ink);
    }
    ASSERT_EQ(taps.points.size(), law.taps.size());
    for (std::size_t k = 0; k < law.taps.size(); ++k) {
      EXPECT_NEAR(taps.points[k].x, std::clamp(2000 * law.taps[k].felt, 20.0, 4000.0), 1e-9);
      EXPECT_NEAR(taps.points[k].y, std::clamp(1e3 * law.taps[k].port, 1e-4, 1e3), 1e-9);
    }
    ASSERT_EQ(mass.points.size(), law.free.size());
    for (std::size_t k = 0; k < law.free.size(); ++k) {
      EXPECT_EQ(mass.points[k].x, law.free[k].f);
      EXPECT_NEAR(mass.points[k].y, 1e3 * law.free[k].inertia, 1e-9);
      EXPECT_EQ(damping.points[k].x, law.free[k].f);
      EXPECT_EQ(damping.points[k].y, law.free[k].damping);
    }
  }
}

void expect_judged(const Characterization& found, const Characterized& subject) {
  const auto check = [&](const std::string& what) {
    const auto at = std::ranges::find(found.outcome.checks, what, &Check::what);
    EXPECT_NE(at, found.outcome.checks.end()) << what;
    return at == found.outcome.checks.end() ? Check{} : *at;
  };
  const LawRendered &ours = of(found, CouplingKind::predictive),
                    &direct = of(found, CouplingKind::direct);
  EXPECT_NEAR(
      check("predictive: stiffest wall, divided by the wall that `limpid analyze` computes").value,
      ours.wall / std::clamp(ours.named, 50.0, 19000.0), 1e-9);
  const TipAlong tip = tip_of(subject.at.arm);
  const Check by_theory =
      check("direct coupling: stiffest wall, divided by (b_d + b_h)/(T/2 + delay)");
  EXPECT_NEAR(by_theory.value, direct.wall * (0.5e-3 + 1e-3) / (tip.damping + 2), 1e-6);
  EXPECT_FALSE(by_theory.unjudged.empty());
  for (const auto& [kind, name, bound] : {std::tuple(CouplingKind::predictive, "predictive", 5e-3),
                                          {CouplingKind::tank, "tank", 5e-3},
                                          {CouplingKind::eba, "eba", 1e-3}}) {
    const Check given = check(fmt::format("{}: largest energy given to the hand [J]", name));
    double most = 0;
    for (const Came& came : of(found, kind).taps) most = std::max(most, came.port);
    EXPECT_EQ(given.value, most) << name;
    EXPECT_EQ(given.bound, bound) << name;
  }
  double off = 0;
  for (std::size_t i = 0; i < 4; ++i) {  // 0.5 to 5 Hz
    EXPECT_EQ(ours.free.at(i).f, ours.free_named.at(i).f);
    off = std::max(off, std::abs(ours.free[i].inertia / ours.free_named[i].inertia - 1));
  }
  EXPECT_NEAR(check("predictive: relative deviation of the mass felt from the mass that `limpid "
                    "analyze` computes, 0.5 to 5 Hz")
                  .value,
              off, 1e-9);
  for (const char* words : {"What the built-in arm can render", "at 0.15 m/s", "presses with 4 N",
                            "at most 20 %", "at most 20 mm/s", "from 50 to 20000 N/m",
                            "a grip of 3000 N/m and 4 N s/m", "1 ms of delay"}) {
    EXPECT_THAT(found.outcome.figure.title + found.outcome.figure.caption, HasSubstr(words));
  }
}

TEST_F(ACharacterization, SaysWhatItStandsOnAndWhatEachLawRenders) {
  const Characterized subject = built_in(1);
  const Characterization found = of_built_in(1);
  expect_drawn(found);
  expect_judged(found, subject);
  write_characterization(subject, found, dir / ".");
  std::ifstream page(dir / "report.html");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  EXPECT_THAT(text, HasSubstr("assumed: a test said so"));
  const auto json = nlohmann::json::parse(std::ifstream(dir / "characterize.json"));
  EXPECT_TRUE(json.at("numbers").at(0).at("assumed"));
  EXPECT_EQ(json.at("laws").size(), kBenchLaws.size());
  EXPECT_EQ(json.at("laws").at(0).at("taps").size(), kHands.size());
  for (const BenchLaw& law : kBenchLaws) EXPECT_THAT(text, HasSubstr(info(law.kind).key));
}

// A law that renders, one that is unstable in a hand, and one that is unstable in all.
Characterization made_by_hand() {
  Characterization made;
  const Came lost{HUGE_VAL, HUGE_VAL, 0, HUGE_VAL};
  LawRendered good;
  good.kind = CouplingKind::predictive;
  good.wall = 19066;
  good.named = 18000.4;
  good.bound = "the encoders";
  good.taps = {{1e-4, 0, 1, 0}, {1.25e-3, 0, 0.95, 0}, {0, 0, 1.05, 0}, {0, 0, 0.9, 0}};
  for (const double f : kFreeTold) {
    good.free.push_back({f, 0.04 + 0.001 * f, 0.25, 1});
    good.free_named.push_back({f, 0.05 + 0.001 * f, 0.5, 1});
  }
  LawRendered some = good;
  some.kind = CouplingKind::direct;
  some.wall = 1234.4;
  some.named = 987.6;
  some.bound = "the damping";
  some.taps[1] = lost;
  some.free.resize(1);
  LawRendered none = some;
  none.kind = CouplingKind::proposed;
  none.wall = 50;
  none.taps.assign(4, lost);
  none.free.clear();
  made.laws = {good, some, none};
  made.outcome.figure.title = "What a bench can render";
  made.outcome.figure.panels = {
      {.title = "P", .series = {{"s", kHandInk, Series::Style::line, {{0, 0}, {1, 1}}}}}};
  made.outcome.checks = {at_most("three at most four", 3, 4)};
  return made;
}

TEST(CharacterizedPage, TellsNumbersWallsAndFreeMotionOfEachLaw) {
  const test::TempDir dir;
  Characterized subject = built_in(0);
  subject.numbers = {{"delay", "delay of the device", "ms", 1.5, "a test said so", true},
                     {"friction", "friction", "mN m", 12.3456, "the file", false}};
  write_characterization(subject, made_by_hand(), dir / ".");
  std::ifstream page(dir / "report.html");
  const auto rows = test::cells_of_page(std::string{std::istreambuf_iterator<char>(page), {}});
  ASSERT_EQ(rows.size(), 3u + 4 + 7 + 2);
  EXPECT_THAT(rows[1], ElementsAre("delay of the device", "1.5 ms", "assumed: a test said so"));
  EXPECT_THAT(rows[2], ElementsAre("friction", "12.35 mN m", "the file"));
  EXPECT_THAT(rows[3], ElementsAre("Law", "Stiffest wall [N/m]", "Computed by analyze [N/m]",
                                   "bounded by", "Felt [N/m]", "Given to a hand [mJ]"));
  EXPECT_THAT(rows[4], ElementsAre("predictive", "19066 or more", "18000", "the encoders",
                                   "1800 to 2100", "1.25"));
  EXPECT_THAT(rows[5],
              ElementsAre("direct", "1234", "988", "the damping", "1800 to 2100", "unstable"));
  EXPECT_THAT(rows[6],
              ElementsAre("proposed", "below 50", "988", "the damping", "none", "unstable"));
  EXPECT_THAT(rows[7], ElementsAre("Law", "", "0.5 Hz", "1 Hz", "2 Hz", "5 Hz", "10 Hz"));
  EXPECT_THAT(rows[8],
              ElementsAre("predictive", "measured", "40.5 g, 0.25 N s/m", "41.0 g, 0.25 N s/m",
                          "42.0 g, 0.25 N s/m", "45.0 g, 0.25 N s/m", "50.0 g, 0.25 N s/m"));
  EXPECT_THAT(rows[9],
              ElementsAre("", "analyze", "50.5 g, 0.50 N s/m", "51.0 g, 0.50 N s/m",
                          "52.0 g, 0.50 N s/m", "55.0 g, 0.50 N s/m", "60.0 g, 0.50 N s/m"));
  EXPECT_THAT(rows[10], ElementsAre("direct", "measured", "40.5 g, 0.25 N s/m", "unstable",
                                    "unstable", "unstable", "unstable"));
  EXPECT_EQ(rows[11], rows[9]);
  EXPECT_EQ(rows[12].at(2), "unstable");
  EXPECT_THAT(rows.back(), ElementsAre("three at most four", "3", "&le; 4", "✓ passed"));
}

TEST(CharacterizedFile, HoldsTheSameInBasicUnits) {
  const test::TempDir dir;
  write_characterization(built_in(0), made_by_hand(), dir / ".");
  const auto json = nlohmann::json::parse(std::ifstream(dir / "characterize.json"));
  EXPECT_EQ(json.at("name"), "characterize");
  EXPECT_EQ(json.at("arm"), "omni");
  EXPECT_EQ(json.at("device"), "the built-in arm");
  EXPECT_EQ(json.at("wall_n_per_m"), 2000);
  EXPECT_EQ(json.at("numbers").at(0), (nlohmann::json{{"key", "delay"},
                                                      {"what", "delay"},
                                                      {"value", 0.0},
                                                      {"unit", "ms"},
                                                      {"from", "a test said so"},
                                                      {"assumed", true}}));
  const nlohmann::json &good = json.at("laws").at(0), &some = json.at("laws").at(1),
                       &none = json.at("laws").at(2);
  EXPECT_EQ(good.at("law"), "predictive");
  EXPECT_EQ(good.at("stiffest_n_per_m"), 19066);
  EXPECT_EQ(good.at("analyze_n_per_m"), 18000.4);
  EXPECT_EQ(good.at("analyze_bound"), "the encoders");
  EXPECT_EQ(good.at("free_stable"), true);
  ASSERT_EQ(good.at("free").size(), 5u);
  EXPECT_EQ(good.at("free").at(4).at("frequency_hz"), 10);
  EXPECT_NEAR(good.at("free").at(4).at("mass_kg").get<double>(), 0.05, 1e-12);
  EXPECT_EQ(good.at("free").at(4).at("damping_ns_per_m"), 0.25);
  EXPECT_EQ(good.at("free_by_analyze").at(0).at("damping_ns_per_m"), 0.5);
  const double grips[] = {300, 3000, 300, 3000}, dampings[] = {2, 2, 0, 0},
               felt[] = {2000, 1900, 2100, 1800};
  for (std::size_t i = 0; i < 4; ++i) {
    const nlohmann::json& tap = good.at("taps").at(i);
    EXPECT_EQ(tap.at("grip_n_per_m"), grips[i]);
    EXPECT_EQ(tap.at("grip_damping_ns_per_m"), dampings[i]);
    EXPECT_EQ(tap.at("stable"), true);
    EXPECT_NEAR(tap.at("felt_n_per_m").get<double>(), felt[i], 1e-9);
  }
  EXPECT_EQ(good.at("taps").at(1).at("given_j"), 1.25e-3);
  EXPECT_EQ(some.at("taps").at(1).at("stable"), false);
  EXPECT_EQ(some.at("taps").at(1).at("given_j"), nullptr);
  EXPECT_EQ(some.at("free").size(), 1u);
  EXPECT_EQ(none.at("free_stable"), false);
  EXPECT_EQ(none.at("free").size(), 0u);
}

TEST(WallText, SaysWhereTheSearchEnded) {
  EXPECT_EQ(wall_text(50), "below 50");
  EXPECT_EQ(wall_text(50.6), "51");
  EXPECT_EQ(wall_text(18999), "18999");
  EXPECT_EQ(wall_text(19000), "19000 or more");
}

TEST(AtFrequency, FindsThatFrequencyAlone) {
  const std::vector<FeltMotion> felt{{0.5, 1, 2, 3}, {1, 4, 5, 6}};
  EXPECT_EQ(at_frequency(felt, 1), &felt[1]);
  EXPECT_EQ(at_frequency(felt, 0.75), nullptr);
}

}  // namespace
}  // namespace limpid
