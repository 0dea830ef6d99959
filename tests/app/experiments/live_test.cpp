// The live experiments, with a simulated device behind encoders and a hand that nobody measures.
#include "app/experiments/live.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "app/experiments/coordination.h"
#include "app/experiments/signals.h"
#include "app/run/analysis.h"
#include "core/dynamics/arm.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

const Vec3 kStart(0.2, 0, 0.01);

struct HandOf {
  std::function<Vec3(double)> at;
  double stiffness = 300;
};

class LiveExperiments : public testing::Test {
 protected:
  LiveLaboratory lab(const HandOf& hand) {
    LiveLaboratory lab;
    const RunPlan like = plan_in(built_in_arm().description, kTableScene,
                                 hand_path("still", 1e-3, 0.1, hand.at), {});
    lab.arm = like.arm;
    lab.document = like.document;
    lab.run = [this, hand](const LiveTrial& trial) { return run(hand, trial); };
    lab.stiffen = [this](double stiffness) {
      stiffness_ = stiffness;
      stiffnesses_.push_back(stiffness);
    };
    return lab;
  }

  std::vector<LiveTrial> asked_;
  std::vector<Session> made_;          // of each trial
  std::vector<double> stiffnesses_{};  // that the wall was given
  double encoder_step_ = 1e-5;

 private:
  Session run(const HandOf& hand, const LiveTrial& trial) {
    asked_.push_back(trial);
    Parameters p = trial.parameters;
    p.hand_stiffness = hand.stiffness;
    p.encoder_step = encoder_step_;
    RunPlan plan = plan_in(built_in_arm().description, kTableScene,
                           hand_path(trial.name, p.tick, trial.seconds, hand.at), p);
    set_surface_stiffness(plan.document.scene, stiffness_);
    Session s;
    s.info.tick = p.tick;
    s.layout = RowLayout(3);
    simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
      s.rows.insert(s.rows.end(), row.begin(), row.end());
      // A real device's hand is not measured.
      for (double& torque : s.layout.in(std::span(s.rows).last(row.size()), Column::hand_torque)) {
        torque = std::numeric_limits<double>::quiet_NaN();
      }
      return true;
    });
    made_.push_back(s);
    return s;
  }

  double stiffness_ = 600;
};

Outcome run_the(const char* name, LiveLaboratory& bench) {
  const auto all = live_experiments();
  const auto it = std::ranges::find(all, std::string_view(name),
                                    [](const LiveExperiment& e) { return e.name; });
  return it->run(bench);
}

Vec3 pressing(double t) { return kStart - Vec3(0, 0, 0.031 * (1 - std::cos(2 * t))); }
Vec3 swinging(double t) { return kStart + 0.03 * Vec3(0, std::sin(5 * t), 0.5 * std::sin(7 * t)); }

TEST_F(LiveExperiments, CoordinationTellsTheCouplingsApart) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("coordination", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
  EXPECT_EQ(outcome.figure.panels.size(), 3u);
  ASSERT_EQ(asked_.size(), 2u);
  EXPECT_NE(asked_[0].instruction.find("standard"), std::string::npos);
}

TEST_F(LiveExperiments, CoordinationFailsWhereNothingIsTouched) {
  LiveLaboratory bench = lab({swinging});
  EXPECT_FALSE(run_the("coordination", bench).passed());
}

// Both runs have the same law: the second slope is no smaller than the first.
TEST_F(LiveExperiments, CoordinationFailsWhereTheCouplingsAreAlike) {
  LiveLaboratory bench = lab({pressing});
  bench.run = [run = bench.run](LiveTrial trial) {
    trial.parameters.kind = CouplingKind::standard;
    return run(trial);
  };
  const Outcome outcome = run_the("coordination", bench);
  EXPECT_FALSE(outcome.passed());
  const Check& last = outcome.checks.back();
  EXPECT_NEAR(last.value, 1, 1e-9) << last.what;
  EXPECT_FALSE(last.passed);
}

TEST_F(LiveExperiments, InertiaFindsEtaWithoutTheHandsTorque) {
  LiveLaboratory bench = lab({swinging, 3000});
  const Outcome outcome = run_the("inertia", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
}

TEST_F(LiveExperiments, PassivityFindsNoEnergyOnATable) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("passivity", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
}

TEST_F(LiveExperiments, ZwidthStiffensTheWallUntilItBuzzes) {
  encoder_step_ = 1e-4;
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("zwidth", bench);
  for (const Check& c : outcome.checks) EXPECT_TRUE(c.passed) << c.what << ": " << c.value;
  ASSERT_GT(asked_.size(), 2u);
  EXPECT_NE(asked_[0].instruction.find("250 N/m"), std::string::npos);
  EXPECT_NE(asked_[1].instruction.find("500 N/m"), std::string::npos);
}

TEST_F(LiveExperiments, ZwidthSaysThatTheWallWasNotTouched) {
  LiveLaboratory bench = lab({swinging});
  EXPECT_THROW(run_the("zwidth", bench), std::runtime_error);
}

// The curve of a panel, by its title and its label.
const Series& curve_of(const Outcome& outcome, const std::string& title, const std::string& label) {
  static const Series kNone;
  for (const FigurePanel& panel : outcome.figure.panels) {
    if (panel.title != title) continue;
    for (const Series& series : panel.series) {
      if (series.label == label) return series;
    }
  }
  ADD_FAILURE() << title << ": no curve " << label;
  return kNone;
}

// A curve over time has a row's value at each of its points.
template <class Value>
void expect_rows(const Series& curve, const Session& s, const Value& value) {
  EXPECT_GT(curve.points.size(), 1000u) << curve.label;
  for (const FigurePoint& p : curve.points) {
    const auto k = static_cast<std::size_t>(std::llround(p.x / s.info.tick));
    ASSERT_LT(k, s.size());
    EXPECT_NEAR(p.y, value(k), 1e-9 * std::max(1.0, std::abs(p.y))) << curve.label << " at " << p.x;
  }
}

TEST_F(LiveExperiments, CoordinationAsksForTwoLawsAndShowsThem) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("coordination", bench);
  ASSERT_EQ(asked_.size(), 2u);
  const std::pair<const char*, CouplingKind> laws[] = {{"standard", CouplingKind::standard},
                                                       {"proposed", CouplingKind::proposed}};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [law, kind] = laws[i];
    EXPECT_EQ(asked_[i].name, law);
    EXPECT_EQ(asked_[i].parameters.kind, kind);
    EXPECT_EQ(asked_[i].seconds, 20);
    EXPECT_NE(asked_[i].instruction.find("three times within 20 s"), std::string::npos);
    const Session& s = made_[i];
    expect_rows(curve_of(outcome, "Contact torque |f2|", law), s,
                [&](auto k) { return vector_at(s, k, Column::contact_torque).norm(); });
    expect_rows(curve_of(outcome, "Coordination error |x1 - x2|", law), s,
                [&](auto k) { return 1e3 * coordination_error(s, k).norm(); });
    EXPECT_EQ(outcome.checks[i].value, lasting_contacts(s));
    EXPECT_EQ(outcome.checks[i].bound, 3);
  }
  EXPECT_NEAR(outcome.checks[2].value,
              std::abs(contact_slope(made_[0]) * bench.parameters.k_vc - 1), 1e-9);
  EXPECT_NEAR(outcome.checks[3].value, contact_slope(made_[1]) / contact_slope(made_[0]), 1e-9);
}

// The second and third eta are judged: the share of inertia by (24), that of damping by eta.
void expect_inertia_judged(const Outcome& outcome, std::size_t i, double eta, double inertia,
                           double damping) {
  if (i == 0) return;
  const Parameters p;
  const double b = 0.012 + p.b_v + p.k_vc * p.tick / 2;
  const Check &of_inertia = outcome.checks.at(2 * i - 1), &of_damping = outcome.checks.at(2 * i);
  EXPECT_NEAR(of_inertia.value, std::abs(inertia - eta * (1 + (1 - eta) * b / p.alpha)), 1e-9);
  EXPECT_NEAR(of_damping.value, std::abs(damping - eta), 1e-9);
  const std::string told = fmt::format("felt at eta = {:.2f}, ", eta);
  EXPECT_EQ(of_inertia.what.find("inertia " + told), 0u) << of_inertia.what;
  EXPECT_EQ(of_damping.what.find("damping " + told), 0u) << of_damping.what;
  EXPECT_EQ(of_inertia.bound, 0.25);
  EXPECT_EQ(of_damping.bound, 0.25);
}

TEST_F(LiveExperiments, InertiaAsksForThreeEtasAndDividesByTheFirst) {
  LiveLaboratory bench = lab({swinging, 3000});
  const Outcome outcome = run_the("inertia", bench);
  ASSERT_EQ(asked_.size(), 3u);
  const double least =
      analyze(bench.arm, rest_pose(bench.arm), bench.parameters, std::nullopt).eta_min;
  const double etas[] = {1, std::max(0.6, 1.1 * least), 1.75};
  const Felt one = felt_of(made_[0], bench.arm);
  const std::string shares = "Inertia and damping felt, divided by their values at eta = 1";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(asked_[i].parameters.kind, CouplingKind::proposed);
    EXPECT_NEAR(asked_[i].parameters.eta, etas[i], 1e-12);
    EXPECT_EQ(asked_[i].seconds, 15);
    EXPECT_EQ(asked_[i].name, fmt::format("eta-{:.2f}", etas[i]));
    EXPECT_EQ(asked_[i].instruction.find(fmt::format("eta = {:.2f}: for 15 s, swing", etas[i])),
              0u);
    const Session& s = made_[i];
    expect_rows(curve_of(outcome, "Estimate of the human torque |f1|",
                         fmt::format("eta = {:.2f}", etas[i])),
                s, [&](auto k) { return vector_at(s, k, Column::hand_torque_estimate).norm(); });
    const Felt felt = felt_of(s, bench.arm);
    const FigurePoint& inertia = curve_of(outcome, shares, "inertia").points.at(i);
    const FigurePoint& damping = curve_of(outcome, shares, "damping").points.at(i);
    EXPECT_NEAR(inertia.x, etas[i], 1e-12);
    EXPECT_NEAR(inertia.y, felt.inertia / one.inertia, 1e-9);
    EXPECT_NEAR(damping.y, felt.damping.mean() / one.damping.mean(), 1e-9);
    expect_inertia_judged(outcome, i, etas[i], inertia.y, damping.y);
  }
  EXPECT_EQ(outcome.checks.at(0).value, one.inertia);
  // Lines: eta of the damping; (24) of the inertia, where the estimate lags by m / alpha.
  const Parameters& p = bench.parameters;
  const double b = device_damping(bench.arm, p).mean() + p.b_v + p.k_vc * p.tick / 2;
  std::size_t lines = 0;
  for (const Series& line : outcome.figure.panels.at(1).series) {
    if (line.style != Series::Style::dashed) continue;
    ++lines;
    EXPECT_NEAR(line.points.front().x, 0.4, 1e-9);
    EXPECT_NEAR(line.points.back().x, 2, 0.051);
    for (const FigurePoint& at : line.points) {
      const double by_24 = at.x * (1 + (1 - at.x) * b / p.alpha);
      EXPECT_TRUE(std::abs(at.y - at.x) < 1e-9 || std::abs(at.y - by_24) < 1e-9) << at.x;
    }
  }
  EXPECT_EQ(lines, 2u);
}

TEST_F(LiveExperiments, PassivityShowsTheEnergyOfThreeLaws) {
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("passivity", bench);
  ASSERT_EQ(asked_.size(), 3u);
  const char* laws[] = {"standard", "proposed", "predictive"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(asked_[i].name, laws[i]);
    EXPECT_STREQ(name(asked_[i].parameters.kind), laws[i]);
    EXPECT_EQ(asked_[i].seconds, 20);
    EXPECT_EQ(
        asked_[i].instruction.find(fmt::format("The {} coupling: for 20 s, move freely", laws[i])),
        0u);
    const Session& s = made_[i];
    expect_rows(curve_of(outcome, "Total", laws[i]), s,
                [&](auto k) { return 1e3 * s.at(k, Column::energy_total)[0]; });
    double highest = 0;
    for (std::size_t k = 0; k < s.size(); ++k) {
      highest = std::max(highest, s.at(k, Column::energy_total)[0]);
    }
    EXPECT_EQ(outcome.checks.at(2 * i).value, lasting_contacts(s));
    EXPECT_EQ(outcome.checks.at(2 * i + 1).value, highest);
  }
}

// Each wall is twice as stiff as the one before, until one buzzes above 20 mm/s.
TEST_F(LiveExperiments, ZwidthDoublesTheWallUntilItBuzzes) {
  encoder_step_ = 1e-4;
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = run_the("zwidth", bench);
  std::size_t at = 0;
  double stiffest[2] = {};
  const char* laws[] = {"proposed", "predictive"};
  for (std::size_t i = 0; i < 2; ++i) {
    const Series& line = curve_of(outcome, "Chatter in contact", laws[i]);
    double wall = 250;
    for (const FigurePoint& p : line.points) {
      ASSERT_LT(at, asked_.size());
      EXPECT_EQ(p.x, wall);
      EXPECT_EQ(stiffnesses_[at], wall);
      EXPECT_EQ(asked_[at].name, fmt::format("{}-{:.0f}", laws[i], wall));
      EXPECT_EQ(asked_[at].seconds, 6);
      EXPECT_EQ(asked_[at].instruction.find(
                    fmt::format("Wall of {:.0f} N/m, {} coupling: for 6 s, tap", wall, laws[i])),
                0u);
      EXPECT_NEAR(p.y, 1e3 * chatter_in_contact(made_[at], bench.arm), 1e-9);
      const bool last = &p == &line.points.back();
      if (!last) {
        EXPECT_LE(p.y, 20) << wall;
      } else if (wall < 16000) {
        EXPECT_GT(p.y, 20) << wall;
      }
      if (p.y <= 20) stiffest[i] = wall;
      wall *= 2;
      ++at;
    }
  }
  EXPECT_EQ(at, asked_.size());
  EXPECT_EQ(outcome.checks[0].value, stiffest[0]);
  EXPECT_NEAR(outcome.checks[1].value, stiffest[1] / stiffest[0], 1e-12);
}

// Compared with rows made by hand: a torque of 0.7 M a, and one joint with a damper.
TEST_F(LiveExperiments, WhatIsFeltIsTheTorqueAlongTheMotion) {
  const ArmDescription arm = lab({swinging}).arm;
  Session s;
  s.info.tick = 1e-3;
  s.layout = RowLayout(3);
  const Eigen::Vector3d rest = rest_pose(arm);
  for (int k = 0; k < 4000; ++k) {
    const double w = 6, t = 1e-3 * k;
    Eigen::Vector3d sway(0.1, -0.07, 0.12);
    const Eigen::Vector3d x = rest + sway * std::sin(w * t);
    const Eigen::Vector3d a = -w * w * sway * std::sin(w * t);
    Eigen::Vector3d torque = 0.7 * (arm_at(arm, x).M * a);
    torque += 0.02 * Eigen::Vector3d(std::cos(w * t), 0, 0);
    std::vector<double> row(static_cast<std::size_t>(s.layout.stride()), 0.0);
    const auto put = [&](Column c, const Eigen::Vector3d& v) {
      std::copy_n(v.data(), 3, s.layout.in(std::span(row), c).begin());
    };
    s.layout.in(std::span(row), Column::alpha)[0] = 1e9;  // an observer without a lag
    put(Column::device_position, x);
    put(Column::hand_torque_estimate, torque);
    s.rows.insert(s.rows.end(), row.begin(), row.end());
  }
  const Felt felt = felt_of(s, arm);
  EXPECT_NEAR(felt.inertia, 0.7, 0.01);
  EXPECT_NEAR(felt.damping[0], 0.02 / (0.1 * 6), 1e-3);
  EXPECT_NEAR(felt.damping[1], 0, 1e-3);
}

// The recording must be longer than what smooths it.
TEST_F(LiveExperiments, WhatIsFeltNeedsALongerRecordingThanThat) {
  const ArmDescription arm = lab({swinging}).arm;
  Session s;
  s.info.tick = 1e-3;
  s.layout = RowLayout(3);
  s.rows.assign(199 * static_cast<std::size_t>(s.layout.stride()), 0.0);
  try {
    felt_of(s, arm);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("the recording is too short"), std::string::npos);
  }
}

// Rows made by hand: where it touches, the tip swings at 50 Hz; elsewhere faster.
TEST_F(LiveExperiments, ChatterIsTheTipsFastMotionWhereItTouches) {
  const ArmDescription arm = lab({swinging}).arm;
  Session s;
  s.info.tick = 1e-3;
  s.layout = RowLayout(3);
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  s.rows.assign(2000 * stride, 0.0);
  const Eigen::VectorXd rest = rest_at(arm, Vec3(0.2, 0, 0)).x1;
  for (std::size_t k = 0; k < 2000; ++k) {
    const auto row = std::span(s.rows).subspan(k * stride, stride);
    const double t = 1e-3 * static_cast<double>(k), w = 2 * M_PI * 50;
    Eigen::VectorXd x = rest;
    x[0] += (k < 500 ? 5e-4 : 1e-4) * std::sin(w * t) + 0.1 * std::sin(2 * M_PI * t);
    std::ranges::copy(x, s.layout.in(row, Column::device_position).begin());
    s.layout.in(row, Column::contact_torque)[0] = k >= 1000 ? 0.1 : 0;
  }
  const double speed = 0.2 * 1e-4 * 2 * M_PI * 50 / std::sqrt(2.0);
  EXPECT_NEAR(chatter_in_contact(s, arm), speed, 0.02 * speed);
  s.rows.assign(2000 * stride, 0.0);
  EXPECT_EQ(chatter_in_contact(s, arm), 0) << "nothing is touched";
}

Outcome made_live(LiveLaboratory&) {
  Outcome outcome;
  outcome.figure.title = "Made";
  outcome.figure.caption = "By hand.";
  outcome.figure.panels = {
      {.title = "P", .series = {{"s", kHandInk, Series::Style::line, {{0, 0}, {1, 1}}}}}};
  outcome.checks = {at_most("three at most four", 3, 4)};
  return outcome;
}

// Files of a live experiment have names of their own, and tell of the device alone.
TEST_F(LiveExperiments, LeaveFilesThatTheReportShows) {
  const test::TempDir dir;
  LiveLaboratory bench = lab({pressing});
  const Outcome outcome = carry_out(LiveExperiment{"zwidth", "made", made_live}, bench, dir / ".");
  EXPECT_EQ(outcome.figure.caption,
            "By hand. Conditions: arm omni of 3 joints; limit of every motor: the arm's own, 0.45 "
            "and 0.64 N m; tick 1 ms.");
  EXPECT_FALSE(outcome.figure.made_by.empty());
  for (const char* end : {".csv", ".png", ".svg", ".json"}) {
    EXPECT_TRUE(std::filesystem::exists(dir / "." / (std::string("live-zwidth") + end))) << end;
  }
  write_report(dir / ".");
  std::ostringstream page;
  page << std::ifstream(dir / "report.html").rdbuf();
  for (const char* words : {"1 of 1 experiments passed", "live-zwidth.svg",
                            "the stiffest wall that does not vibrate in your hand", "By hand."}) {
    EXPECT_NE(page.str().find(words), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace limpid
