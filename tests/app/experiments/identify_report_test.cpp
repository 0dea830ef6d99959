// Words and files of an identification, from findings made by hand.
#include "app/experiments/identify_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "app/experiments/identification.h"
#include "app/run/analysis.h"
#include "devices/files/urdf_file.h"
#include "devices/identify/unlike_device.h"
#include "tests/app/experiments/cells_of_page.h"
#include "tests/support/built_in.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using test::cells_of_page;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string text_in(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

// Two joints, shoulder and elbow, each with its own numbers.
Identification made_findings() {
  Identification made;
  made.device = "a bench";
  made.order.guess = read_urdf(test::assets_dir() / "devices/planar2.urdf");
  made.order.load = 0.03;
  made.torque_scale = Found{1.25, 0.03};
  made.inertia_in_file = {0.0015, 0.00025};
  made.bare.end = ExcitationEnd::complete;
  made.bare.record.T = 0.002;
  made.bare.record.x.resize(3, 2);
  made.bare.record.x << 0.1, 0.2, 0.3, 0.4, 0.5, -0.625;
  made.bare.record.torque = -2 * made.bare.record.x;
  made.bare.timing = {.rate = 1000,
                      .intervals = {0.00101, 0.00101, 0.00101, 0.00026, 0.0035},
                      .p50 = 0.00101,
                      .p99 = 0.00125,
                      .most = 0.0035};
  Identified& found = made.found;
  found.arm = made.order.guess;
  found.middle = Eigen::Vector2d(0.25, -0.5);
  found.delay = {0.0021, 1e-5};
  found.joints = {{.inertia = {0.0012348, 0.00002},
                   .gravity = {0.25, 0.03},
                   .viscous = {0.001, 0.0002},
                   .coulomb = {0.0123456, 0.0002},
                   .offset = {0.01234, 0.0021},
                   .spring = {-1e-8, 1e-4},
                   .residual = 0.002,
                   .torque = 0.05,
                   .samples = 700},
                  {.inertia = {0.0002, 0.00003},
                   .gravity = {0.5, 0.1},
                   .viscous = {0.003, 0.0004},
                   .coulomb = {0.02, 0.005},
                   .offset = {0.004, 0.001},
                   .spring = {0.006, 0.002},
                   .residual = 0.003,
                   .torque = 0.03,
                   .samples = 800}};
  found.moments = {{.time = 0,
                    .joint = 0,
                    .velocity = 2,
                    .torque = 0.05,
                    .bodies = 0.02,
                    .springs = 0.004,
                    .friction = 0.025},
                   {.time = 0,
                    .joint = 1,
                    .velocity = 9,
                    .torque = 0.3,
                    .bodies = 0.1,
                    .springs = 0.1,
                    .friction = 0.1},
                   {.time = 1,
                    .joint = 0,
                    .velocity = -3,
                    .torque = -0.03,
                    .bodies = -0.01,
                    .springs = -0.001,
                    .friction = -0.018}};
  return made;
}

TEST(IdentifyPage, HasARowForEachJoint) {
  const test::TempDir dir;
  write_identification(made_findings(), std::nullopt, dir / "");
  const std::string html = text_in(dir / "report.html");
  const auto rows = cells_of_page(html);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0], ElementsAre("joint", "inertia [g m²]", "weight [mN m]", "friction [mN m]",
                                   "damping [mN m s/rad]", "spring [mN m/rad]", "offset [mN m]",
                                   "inertia in its file [g m²]", "not explained"));
  EXPECT_THAT(rows[1], ElementsAre("shoulder", "1.235 ± 0.020", "250 ± 30", "12.35 ± 0.20",
                                   "1.00 ± 0.20", "0.00 ± 0.10", "12.3 ± 2.1", "1.500", "4.0 %"));
  EXPECT_THAT(rows[2], ElementsAre("elbow", "0.200 ± 0.030", "500 ± 100", "20.0 ± 5.0",
                                   "3.00 ± 0.40", "6.0 ± 2.0", "4.0 ± 1.0", "0.250", "10.0 %"));
  EXPECT_THAT(html, HasSubstr("Identification of a bench"));
  EXPECT_THAT(html, HasSubstr("Arm from which the identification started: planar2."));
  EXPECT_THAT(html, HasSubstr(device_text(made_findings())));
  EXPECT_THAT(html, HasSubstr("identified.svg"));
  EXPECT_THAT(html, Not(HasSubstr("Since last time")));
}

TEST(IdentifyPage, SaysOfTheDeviceWhatWasFound) {
  Identification made = made_findings();
  const std::string delay =
      "Delay from a reading to the torque computed from it: 2.100 ± 0.010 ms. The tick is not "
      "included.";
  const std::string motors = " The motors give 1.250 ± 0.030 times the commanded torque, computed ";
  EXPECT_EQ(device_text(made),
            delay +
                " 1000 readings per second. Time between two readings: median 1.01 ms, 99th "
                "percentile 1.25 ms, longest 3.50 ms." +
                motors + "from a load of 0.03 kg at the tip.");
  made.bare.timing = {};
  made.order.load = 0;
  EXPECT_EQ(device_text(made), delay + motors + "from the masses of the arm's file.");
  made.torque_scale.reset();
  EXPECT_EQ(device_text(made), delay);
}

// Certain is what neither three deviations of both nor 3 % explain.
TEST(IdentifyPage, ComparesWithTheLastTime) {
  const Identification made = made_findings();
  Findings last{.when = "2026-01-02T03:04:05", .joints = made.found.joints, .delay = {0.002, 1e-5}};
  last.joints[0].inertia = {0.0012, 0.00002};  // 35 of 85 + 36 mg m^2
  last.joints[0].gravity = {0.1, 0.01};        // 150 of 95 + 3 mN m
  last.joints[1].coulomb = {0.06, 0.005};      // 40 of 21 + 1.8 mN m
  last.joints[1].viscous = {0.0048, 0.0004};   // 1.8 of 1.7 + 0.14 mN m s/rad
  const auto certain = [&](const Identification& now) {
    std::vector<std::string> all;
    for (const Drift& d : drift(last, now)) {
      if (d.certain) all.push_back(d.what);
    }
    return all;
  };
  EXPECT_THAT(certain(made), ElementsAre("shoulder weight", "elbow friction"));
  Identification late = made;
  late.found.delay.value = 0.00212;  // 0.12 of 0.042 + 0.06 ms
  EXPECT_THAT(certain(late), ElementsAre("shoulder weight", "elbow friction", "delay"));
  late.found.joints.pop_back();
  EXPECT_TRUE(drift(last, late).empty()) << "of another number of joints";

  const test::TempDir dir;
  write_identification(made, last, dir / "");
  const std::string html = text_in(dir / "report.html");
  EXPECT_THAT(html, HasSubstr("2026-01-02T03:04:05"));
  const auto rows = cells_of_page(html);
  ASSERT_EQ(rows.size(), 3u + 1 + 2 * 6 + 1);
  EXPECT_THAT(rows[3], ElementsAre("what", "unit", "then", "now", ""));
  EXPECT_THAT(rows[4],
              ElementsAre("shoulder inertia", "g m^2", "1.200 ± 0.020", "1.235 ± 0.020", ""));
  EXPECT_THAT(rows[5], ElementsAre("shoulder weight", "mN m", "100 ± 10", "250 ± 30", "changed"));
  EXPECT_THAT(rows[12],
              ElementsAre("elbow friction", "mN m", "60.0 ± 5.0", "20.0 ± 5.0", "changed"));
  EXPECT_THAT(rows.back(), ElementsAre("delay", "ms", "2.000 ± 0.010", "2.100 ± 0.010", ""));
}

TEST(IdentifyFiles, HoldEachFindingInBasicUnits) {
  const Identification made = made_findings();
  const auto json = nlohmann::json::parse(findings_text(made, R"({"seed": 7})"));
  EXPECT_EQ(json.at("device"), "a bench");
  EXPECT_EQ(json.at("arm"), "planar2");
  EXPECT_EQ(json.at("seed"), 7);
  EXPECT_NEAR(json.at("seconds").get<double>(), 3 * 0.002, 1e-12);
  EXPECT_EQ(json.at("delay"), (nlohmann::json{{"value", 0.0021}, {"deviation", 1e-5}}));
  EXPECT_EQ(json.at("torque_scale"), (nlohmann::json{{"value", 1.25}, {"deviation", 0.03}}));
  EXPECT_EQ(json.at("load"), 0.03);
  EXPECT_EQ(json.at("readings"), (nlohmann::json{{"rate", 1000.0},
                                                 {"interval_p50", 0.00101},
                                                 {"interval_p99", 0.00125},
                                                 {"interval_max", 0.0035}}));
  ASSERT_EQ(json.at("joints").size(), 2u);
  const nlohmann::json& elbow = json.at("joints").at(1);
  EXPECT_EQ(elbow.at("name"), "elbow");
  EXPECT_EQ(elbow.at("middle"), -0.5);
  EXPECT_EQ(elbow.at("inertia"), (nlohmann::json{{"value", 0.0002}, {"deviation", 0.00003}}));
  EXPECT_EQ(elbow.at("weight").at("value"), 0.5);
  EXPECT_EQ(elbow.at("coulomb").at("value"), 0.02);
  EXPECT_EQ(elbow.at("viscous").at("value"), 0.003);
  EXPECT_EQ(elbow.at("spring").at("value"), 0.006);
  EXPECT_EQ(elbow.at("offset").at("value"), 0.004);
  EXPECT_EQ(elbow.at("residual"), 0.003);
  EXPECT_EQ(elbow.at("torque"), 0.03);
  EXPECT_EQ(elbow.at("samples"), 800);
  EXPECT_EQ(json.at("when").get<std::string>().size(), std::string("2026-01-02T03:04:05").size());
  Identification bare = made;
  bare.torque_scale.reset();
  bare.order.load = 0;
  bare.bare.timing = {};
  const auto less = nlohmann::json::parse(findings_text(bare));
  for (const char* key : {"torque_scale", "load", "readings", "seed"}) {
    EXPECT_FALSE(less.contains(key)) << key;
  }
  const DeviceHub::Profile profile = profile_of(made), told = profile_of(bare);
  EXPECT_EQ(profile.delay, 0.0021);
  EXPECT_EQ(profile.torque_scale, 1.25);
  EXPECT_EQ(told.torque_scale, 1);
  EXPECT_THAT(profile.urdf, HasSubstr("on a bench, from planar2"));
  EXPECT_EQ(read_findings(profile.report)->joints.size(), 2u);
}

TEST(IdentifyFiles, HoldTheMotionInATable) {
  const test::TempDir dir;
  write_motion(made_findings().bare, dir / "motion.csv");
  EXPECT_EQ(text_in(dir / "motion.csv"),
            "time,x1,x2,torque1,torque2\n"
            "0.000,0.1,0.2,-0.2,-0.4\n"
            "0.002,0.3,0.4,-0.6,-0.8\n"
            "0.004,0.5,-0.625,-1,1.25\n");
  EXPECT_THROW(write_motion(made_findings().bare, dir / "motion.csv/again.csv"), FileError);
}

void expect_points(const Series& curve, const std::vector<std::pair<double, double>>& points) {
  ASSERT_EQ(curve.points.size(), points.size()) << curve.label;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(curve.points[i].x, points[i].first, 1e-9) << curve.label << ' ' << i;
    EXPECT_NEAR(curve.points[i].y, points[i].second, 1e-9) << curve.label << ' ' << i;
  }
}

// In mN m: all parts of a moment's torque over the motor's, and what friction is left with.
TEST(IdentifyFigures, ShowTheMomentsOfEachJoint) {
  const Figure figure = identify_figure(made_findings());
  EXPECT_EQ(figure.title, "Identification of a bench");
  EXPECT_THAT(figure.caption, HasSubstr("delay 2.100 +- 0.010 ms"));
  ASSERT_EQ(figure.panels.size(), 5u);
  const char* titles[] = {"shoulder: torque", "shoulder: friction", "elbow: torque",
                          "elbow: friction", "readings"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(figure.panels[i].title, titles[i]);
  const auto& torque = figure.panels[0].series;
  ASSERT_EQ(torque.size(), 2u);
  expect_points(torque[0], {{49, 50}, {-29, -30}});
  EXPECT_EQ(torque[0].style, Series::Style::points);
  expect_points(torque[1], {{-30, -30}, {50, 50}});
  const auto& friction = figure.panels[1].series;
  ASSERT_EQ(friction.size(), 3u);
  expect_points(friction[0], {{2, 26}, {-3, -19}});
  expect_points(friction[1], {{-3, -3 - 12.3456}, {0, -12.3456}});
  expect_points(friction[2], {{0, 12.3456}, {2, 2 + 12.3456}});
  expect_points(figure.panels[2].series[0], {{300, 300}});
  expect_points(figure.panels[2].series[1], {{0, 0}, {300, 300}});
  expect_points(figure.panels[3].series[2], {{0, 20}, {9, 27 + 20}});
}

// Sixty bars up to 1.2 of the 99th percentile; what is longer is beyond them.
TEST(IdentifyFigures, ShowHowOftenEachIntervalCame) {
  Identification made = made_findings();
  const Series bars = identify_figure(made).panels.back().series.at(0);
  ASSERT_EQ(bars.points.size(), 120u);
  EXPECT_NEAR(bars.points.front().x, 0, 1e-12);
  EXPECT_NEAR(bars.points.back().x, 1.5, 1e-12);
  for (std::size_t i = 0; i < 60; ++i) {
    const double wanted = i == 40 ? 60 : i == 10 ? 20 : 0;
    for (const std::size_t side : {0, 1}) {
      const FigurePoint& p = bars.points[2 * i + side];
      EXPECT_NEAR(p.x, 0.025 * static_cast<double>(i + side), 1e-9);
      EXPECT_NEAR(p.y, wanted, 1e-9) << i;
    }
  }
  made.bare.timing = {};
  EXPECT_EQ(identify_figure(made).panels.size(), 4u) << "nothing is known of them";
}

TEST(IdentifyExplains, WhyAMotionEnded) {
  IdentifyRequest order;
  order.guess = made_findings().order.guess;
  IdentifyRun run;
  run.end = ExcitationEnd::held;
  run.joint = 1;
  EXPECT_EQ(explain(run, order), std::string(explain(ExcitationEnd::held)) + " (elbow)");
  run.end = ExcitationEnd::limit;
  run.objection = ForceState::too_fast;
  EXPECT_EQ(explain(run, order), std::string(explain(ExcitationEnd::limit)) + " (" +
                                     explain(ForceState::too_fast) + ")");
  run.end = ExcitationEnd::complete;
  run.objection = ForceState::on;
  EXPECT_EQ(explain(run, order), explain(ExcitationEnd::complete));
}

// A bench differs from its file, by its seed; its motors only where a load can tell.
TEST(SimulatedBenches, DifferFromTheirFileByTheirSeed) {
  IdentifyRequest order;
  order.guess = read_urdf(test::assets_dir() / "devices/paddle.urdf");
  order.fit.gravity = Vec3(0, 0, -9.81);
  const SimulatedBench plain = simulated_bench(order, 3);
  EXPECT_EQ(plain.name, "paddle, simulated");
  EXPECT_EQ(plain.unlikeness.torque_scale, 1);
  EXPECT_EQ(plain.unlikeness.gravity, order.fit.gravity);
  EXPECT_NE(plain.truth.links.back().mass, order.guess.links.back().mass);
  EXPECT_LE(plain.truth.joints[0].friction, 0.03);
  EXPECT_EQ(simulated_bench(order, 3).truth.links.back().mass, plain.truth.links.back().mass);
  EXPECT_NE(simulated_bench(order, 4).truth.links.back().mass, plain.truth.links.back().mass);
  order.load = 0.05;
  std::set<double> scales;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const double scale = simulated_bench(order, seed).unlikeness.torque_scale;
    EXPECT_GE(scale, 0.7);
    EXPECT_LE(scale, 1.42);
    scales.insert(scale);
  }
  EXPECT_EQ(scales.size(), 4u);
}

// From move to findings: the load is found to weigh on the second motion alone.
TEST(SimulatedBenches, AreIdentifiedWithTheirLoad) {
  IdentifyRequest order;
  order.guess = read_urdf(test::assets_dir() / "devices/paddle.urdf");
  order.load = 0.02;
  SimulatedBench bench = simulated_bench(order, 5);
  bench.unlikeness = {.encoder_step = 1e-4, .delay = 1, .torque_scale = 1.2};
  IdentifyProgress progress;
  const Identification done =
      identification(bench.name, order, move_simulated(bench, order, false, progress),
                     move_simulated(bench, order, true, progress));
  EXPECT_EQ(done.device, "paddle, simulated");
  ASSERT_TRUE(done.torque_scale);
  EXPECT_NEAR(done.torque_scale->value, 1.2, 0.06);
  const Eigen::MatrixXd in_file = arm_at(order.guess, done.found.middle).M;
  ASSERT_EQ(done.inertia_in_file.size(), 1u);
  EXPECT_NEAR(done.inertia_in_file[0], in_file(0, 0), 1e-12);
  const double truly = arm_at(bench.truth, done.found.middle).M(0, 0);
  EXPECT_NEAR(done.found.joints[0].inertia.value, truly, 0.1 * truly);
}

}  // namespace
}  // namespace limpid
