#include "app/desktop/coupling/chatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// A history made by hand: one joint of one of two lanes goes to and fro, and the coupling there
// gives energy.
struct Shaken {
  int lane = 0, joint = 0;
  double frequency = 40;          // [Hz]
  double power = 0.02;            // [W]
  double from = 0.01, to = 0.01;  // amplitude at the begin and at the end [rad]
  double compensation = 0.5;      // power for the device's own forces [W]
};
class MadeHistory {
 public:
  static constexpr double kTick = 0.001;

  int count() const { return channels_.count(); }
  History& history() { return history_; }
  // The square of the amplitude changes evenly, as the spring's energy does.
  void go_on(double seconds, const Shaken& how) {
    const int ticks = static_cast<int>(std::lround(seconds / kTick));
    for (int i = 0; i < ticks; ++i) {
      std::vector<double> values(static_cast<std::size_t>(2 * count()), 0.0);
      const auto at = [&](Channel channel, int more = 0) -> double& {
        return values[static_cast<std::size_t>(how.lane * count() + static_cast<int>(channel) +
                                               more)];
      };
      const double part = static_cast<double>(i) / ticks;
      const double square = (1 - part) * how.from * how.from + part * how.to * how.to;
      for (int j = 0; j < 3; ++j) {
        at(Channel::joints, j) = 1e-4 * std::sin(2 * std::numbers::pi * 3 * time_);
      }
      at(Channel::joints, how.joint) =
          std::sqrt(square) * std::sin(2 * std::numbers::pi * how.frequency * time_);
      given_ += how.power * kTick;
      compensated_ += how.compensation * kTick;
      at(Channel::energy_total) = given_ + compensated_;
      at(Channel::energy_compensation) = compensated_;
      history_.append(time_, values);
      time_ += kTick;
    }
  }
  void leave_out(double seconds) { time_ += seconds; }

 private:
  TraceChannels channels_{RowLayout(3)};
  History history_{
      {.channels = 2 * TraceChannels(RowLayout(3)).count(), .seconds = 60, .tick = kTick}};
  double time_ = 0, given_ = 0, compensated_ = 0;
};
const Eigen::VectorXd kMadeSprings = Eigen::Vector3d(2, 3, 4);  // [N m/rad]

// The power is that of E_c without what is for the device's own forces.
TEST(Chatter, IsMeasuredInTheJointThatShakesMost) {
  for (const int lane : {0, 1}) {
    for (int joint = 0; joint < 3; ++joint) {
      for (const double frequency : {40.0, 80.0}) {
        MadeHistory made;
        Chatter chatter;
        const auto look = [&] {
          chatter.follow(made.history(), made.history().end(), lane * made.count(), kMadeSprings);
        };
        made.go_on(0.999, {.lane = lane, .joint = joint, .frequency = frequency});
        look();
        EXPECT_FALSE(chatter.there()) << "three stretches after the first are not over";
        made.go_on(0.001, {.lane = lane, .joint = joint, .frequency = frequency});
        look();
        EXPECT_TRUE(chatter.there()) << "lane " << lane << ", joint " << joint;
        EXPECT_NEAR(chatter.power(), 0.02, 1e-4) << "lane " << lane << ", joint " << joint;
        EXPECT_NEAR(chatter.frequency(), frequency, 2.1) << "lane " << lane << ", joint " << joint;
        Chatter other;
        other.follow(made.history(), made.history().end(), (1 - lane) * made.count(), kMadeSprings);
        EXPECT_FALSE(other.there()) << "the other lane is calm";
      }
    }
  }
}

TEST(Chatter, IsFasterThanAHandAndGivesMoreThanNoise) {
  const auto there = [](const Shaken& how) {
    MadeHistory made;
    made.go_on(3, how);
    Chatter chatter;
    chatter.follow(made.history(), made.history().end(), 0, kMadeSprings);
    return chatter.there();
  };
  EXPECT_TRUE(there({.frequency = 24}));
  EXPECT_FALSE(there({.frequency = 12})) << "a hand can shake so";
  EXPECT_TRUE(there({.power = 0.006}));
  EXPECT_FALSE(there({.power = 0.004}));
  EXPECT_FALSE(there({.power = -0.02})) << "it takes energy";
  // The spring of joint 1 holds k x^2 / 2, k a^2 / 4 in the mean: 50 mJ at 0.3162 rad.
  EXPECT_FALSE(there({.power = 0.016, .from = 0.31623, .to = 0})) << "the spring gives it back";
  EXPECT_TRUE(there({.power = 0.032, .from = 0.31623, .to = 0})) << "twice as much";
  EXPECT_TRUE(there({.power = 0.016, .from = 0, .to = 0.31623})) << "the spring takes as well";
}

TEST(Chatter, IsOverWithAPauseOrOtherSprings) {
  MadeHistory made;
  Chatter chatter;
  const auto there = [&](const Eigen::VectorXd& springs) {
    chatter.follow(made.history(), made.history().end(), 0, springs);
    return chatter.there();
  };
  made.go_on(1.5, {});
  ASSERT_TRUE(there(kMadeSprings));
  made.leave_out(0.4);
  made.go_on(0.25, {});
  EXPECT_TRUE(there(kMadeSprings)) << "the stretch before the pause";
  made.go_on(0.25, {});
  EXPECT_TRUE(there(kMadeSprings));
  made.go_on(0.1, {});
  made.leave_out(0.4);
  made.go_on(0.4, {});
  EXPECT_FALSE(there(kMadeSprings)) << "a stretch that stood still in between says nothing";
  made.go_on(1.25, {});
  EXPECT_TRUE(there(kMadeSprings));
  EXPECT_FALSE(there(2 * kMadeSprings)) << "other settings are judged anew";
  made.go_on(1.25, {});
  EXPECT_TRUE(there(2 * kMadeSprings));
  chatter.start_over(made.history().end());
  EXPECT_FALSE(chatter.there());
  EXPECT_EQ(chatter.power(), 0);
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
