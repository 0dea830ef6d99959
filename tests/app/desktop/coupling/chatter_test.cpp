#include "app/desktop/coupling/chatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "app/plot/trace_channels.h"
#include "app/run/analysis.h"
#include "app/run/scene_meshes.h"
#include "app/run/tip_limits.h"
#include "core/dynamics/arm.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

struct Seen {
  double first = -1;  // time of the first chatter [s]; -1: never
  double power = 0, frequency = 0;
};

Seen look_at(RunPlan plan) {
  plan.models = build_meshes(plan.document);
  TraceChannels channels(plan.arm, plan.layout(), {});
  channels.set_limits(motor_limits(plan.arm, plan.parameters));
  History history({.channels = channels.count(), .seconds = 60, .tick = plan.parameters.tick});
  Chatter chatter;
  Seen seen;
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    channels.append(history, row);
    chatter.follow(history, history.end(), 0, coupling_springs(plan.arm, plan.parameters));
    if (chatter.there() && seen.first < 0) {
      seen = {history.end_time(), chatter.power(), chatter.frequency()};
    }
    return true;
  });
  return seen;
}

// A plan whose hand goes down to the height `deep` [m] and stays there.
RunPlan pressing(const char* scene, const Vec3& at, double deep, CouplingKind kind) {
  RunPlan plan = test::plan(scene, "free.csv", 5);
  plan.hand = parse_hand_csv(
      fmt::format("time_s,x_m,y_m,z_m\n0,{0},{1},0.02\n0.5,{0},{1},0.02\n2,{0},{1},{2}\n"
                  "5,{0},{1},{2}\n",
                  at.x(), at.y(), deep),
      "pressed down");
  plan.parameters.kind = kind;
  plan.parameters.eta = 1;
  return plan;
}

RunPlan pressing_a_table(double stiffness, CouplingKind kind) {
  RunPlan plan = pressing("table.toml", Vec3(0.2, 0, 0), -0.045, kind);
  plan.document.scene.objects[0].material.stiffness = stiffness;
  return plan;
}

// The proposed law is stable up to 1500 N/m; 5000 N/m are far beyond.
TEST(Chatter, IsSeenWhereTheProposedLawTouchesATooStiffTable) {
  const Seen seen = look_at(pressing_a_table(5000, CouplingKind::proposed));
  EXPECT_GT(seen.first, 1.5) << "not before it is touched";
  EXPECT_LT(seen.first, 3) << "but within a second or so";
  EXPECT_GT(seen.power, 0.1);
  EXPECT_GT(seen.frequency, 30);
}

TEST(Chatter, IsSeenOnBrass) {
  const Seen seen =
      look_at(pressing("spheres.toml", Vec3(0.230, 0.08, 0), -0.05, CouplingKind::proposed));
  EXPECT_GT(seen.first, 0.5);
}

TEST(Chatter, IsNotSeenOnASoftTableNorUnderTheOtherLaws) {
  EXPECT_EQ(look_at(pressing_a_table(600, CouplingKind::proposed)).first, -1);
  for (const CouplingKind kind :
       {CouplingKind::standard, CouplingKind::predictive, CouplingKind::tank}) {
    EXPECT_EQ(look_at(pressing_a_table(5000, kind)).first, -1) << info(kind).key;
  }
}

// The arm sinks in as its motors give no more: E_c gains joules at their limit, and nothing shakes.
TEST(Chatter, IsNotSeenWhereMotorsAreAtTheirLimitAndStill) {
  RunPlan plan = pressing_a_table(600, CouplingKind::proposed);
  plan.hand = parse_hand_csv(
      "time_s,x_m,y_m,z_m\n0,0.2,0,0.02\n0.5,0.2,0,0.02\n3,0.2,0,-0.09\n5,0.2,0,-0.09\n",
      "pressed hard");
  EXPECT_EQ(look_at(plan).first, -1);
}

// A hand that shakes as fast as it can puts energy in itself.
TEST(Chatter, IsNotSeenInAHandThatShakes) {
  for (const CouplingKind kind : {CouplingKind::standard, CouplingKind::proposed,
                                  CouplingKind::predictive, CouplingKind::tank}) {
    RunPlan plan = test::plan("table.toml", "free.csv", 4);
    std::string path = "time_s,x_m,y_m,z_m\n";
    for (int i = 0; i <= 400; ++i) {
      const double t = 0.01 * i;
      path += fmt::format("{},{},0,{}\n", t, 0.2,
                          -0.03 + 0.015 * std::sin(2 * std::numbers::pi * 10 * t));
    }
    plan.hand = parse_hand_csv(path, "shaken");
    plan.parameters.kind = kind;
    EXPECT_EQ(look_at(plan).first, -1) << info(kind).key;
  }
}

// All scenes with their own hands; a scene may be too stiff for the proposed law.
TEST(Chatter, IsNotSeenWhereHandsAreCalm) {
  for (const std::string scene :
       {"cradle", "cup",     "dial",    "dominoes", "drawer_door", "free",     "gears",
        "keys",   "leaf",    "marbles", "pendulum", "proximal",    "pucks",    "relief",
        "seesaw", "spheres", "stack",   "switch",   "table",       "obstacles"}) {
    const std::string hand = scene == "table" || scene == "obstacles" ? "touch" : scene;
    for (const CouplingKind kind : {CouplingKind::standard, CouplingKind::proposed,
                                    CouplingKind::predictive, CouplingKind::tank}) {
      RunPlan plan = test::plan((scene + ".toml").c_str(), (hand + ".csv").c_str(), 6);
      plan.parameters.kind = kind;
      const TipLimits limits =
          tip_limits(plan.arm, rest_pose(plan.arm), plan.parameters, plan.document.scene);
      const bool holds = limits.scene <= limits.wall(kind).stiffness;
      if (kind == CouplingKind::proposed && !holds) continue;
      EXPECT_EQ(look_at(plan).first, -1) << scene << " " << info(kind).key;
    }
  }
}

// A recording is played from anywhere: chatter is there where it was, and not before it began.
TEST(PlayedChatter, IsThereAfterAJumpToAnyPlace) {
  const RunPlan plan = pressing_a_table(5000, CouplingKind::proposed);
  TraceChannels channels(plan.arm, plan.layout(), {});
  History history({.channels = channels.count(), .seconds = 60, .tick = plan.parameters.tick});
  Chatter live;
  std::vector<bool> wanted;
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    channels.append(history, row);
    live.follow(history, history.end(), 0, coupling_springs(plan.arm, plan.parameters));
    wanted.push_back(live.there());
    return true;
  });
  const auto began = static_cast<SampleIndex>(std::ranges::find(wanted, true) - wanted.begin());
  ASSERT_LT(began + 1000, wanted.size());
  PlayedChatter played;
  const auto there = [&](SampleIndex at) {
    return played.there(history, at, 0, coupling_springs(plan.arm, plan.parameters));
  };
  for (SampleIndex at = 0; at + 16 < began; at += 16) EXPECT_FALSE(there(at)) << at;
  EXPECT_TRUE(there(began + 500));
  EXPECT_FALSE(there(began / 2)) << "a jump back";
  EXPECT_TRUE(there(began + 1000)) << "a jump there";
}

}  // namespace
}  // namespace limpid
