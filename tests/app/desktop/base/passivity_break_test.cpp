#include "app/desktop/base/passivity_break.h"

#include <gtest/gtest.h>

#include "app/plot/trace_channels.h"
#include "app/run/analysis.h"
#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

// Energy that the coupling itself gives while a hand holds the arm still, after a nudge [J].
double given_while_held(const Parameters& p) {
  RunPlan plan = test::plan("free.toml", "free.csv", 3);
  const Vec3 start = plan.hand.position.front();
  const Vec3 nudged = start + Vec3::Constant(1e-4);
  plan.hand = parse_hand_csv(
      fmt::format("time_s,x_m,y_m,z_m\n0,{0},{1},{2}\n0.1,{0},{1},{2}\n0.12,{3},{4},{5}\n"
                  "4,{3},{4},{5}\n",
                  start.x(), start.y(), start.z(), nudged.x(), nudged.y(), nudged.z()),
      "held still after a nudge");
  plan.parameters = p;
  TraceChannels channels(RowLayout(3));
  channels.set_limits(motor_limits(plan.arm, p));
  History history({.channels = channels.count(), .seconds = 10});
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    channels.append(history, row);
    return true;
  });
  EnergyAccount account;
  account.follow(history, history.end(), channels.lane(kMainLane));
  return account.without_limits();
}

TEST(PassivityBreak, MakesTheLoopGiveEnergyUntilItEnds) {
  const ArmDescription arm = test::omni();
  Settings s;
  s.parameters() = {};
  EXPECT_FALSE(passivity_broken(s));
  break_passivity(s, arm);
  EXPECT_TRUE(passivity_broken(s));
  EXPECT_LT(s.parameters().eta,
            analyze(arm, rest_pose(arm), s.parameters(), std::nullopt).eta_min_grip);
  EXPECT_GT(given_while_held(s.parameters()), 1e-2) << "ten times what the panel calls a fault";
  end_passivity_break(s);
  EXPECT_FALSE(passivity_broken(s));
  EXPECT_LT(given_while_held(s.parameters()), 1e-3);
}

// The predictive law holds in the grip in which the proposed one gives energy.
TEST(PassivityBreak, IsMendedByThePredictiveLawToo) {
  Parameters p = without_passivity(Parameters{}, test::omni());
  p.kind = CouplingKind::predictive;
  EXPECT_LT(given_while_held(p), 1e-3);
}

// All lanes run, with settings of their own.
Settings of_lanes(std::size_t edited) {
  Settings s;
  s.lanes.count = kMostLanes;
  s.lanes.edited = edited;
  using enum CouplingKind;
  constexpr std::array kKinds{standard, predictive, tank};
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    Parameters& p = s.lanes.parameters[i];
    p.kind = kKinds[i];
    p.eta = 0.4 + static_cast<double>(i);
    p.hand_stiffness = 123;
    p.hand_damping = 4;
  }
  return s;
}

TEST(PassivityBreak, PutsEverythingOfAllLanesBackWhateverWasMovedMeanwhile) {
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    const Settings before = of_lanes(lane);
    Settings s = before;
    break_passivity(s, test::omni());
    Parameters& run = s.lanes.parameters[lane];
    EXPECT_EQ(run.kind, CouplingKind::proposed);
    for (std::size_t i = 0; i < kMostLanes; ++i) {
      EXPECT_EQ(s.lanes.parameters[i].hand_stiffness, 3000) << "one hand holds all";
      if (i == lane) continue;
      EXPECT_EQ(s.lanes.parameters[i].kind, before.lanes.parameters[i].kind);
    }
    run.alpha = 0.02;
    run.eta = 0.3;
    s.parameters().hand_mass = 0.1;
    break_passivity(s, test::omni());  // like another press of the button
    end_passivity_break(s);
    EXPECT_EQ(s.lanes, before.lanes);
  }
}

TEST(PassivityBreak, EndsWithTheLawThatIsChosenInItsPlace) {
  for (std::size_t lane = 0; lane < kMostLanes; ++lane) {
    const Settings before = of_lanes(lane);
    Settings s = before;
    break_passivity(s, test::omni());
    EXPECT_FALSE(end_break_by_law(s));
    Parameters& run = s.lanes.parameters[lane];
    run.eta = 0.3;
    EXPECT_FALSE(end_break_by_law(s)) << "its limit may be looked for";
    run.kind = CouplingKind::predictive;
    EXPECT_TRUE(end_break_by_law(s));
    EXPECT_FALSE(passivity_broken(s));
    EXPECT_EQ(run.kind, CouplingKind::predictive);
    run.kind = before.lanes.parameters[lane].kind;
    EXPECT_EQ(s.lanes, before.lanes);
  }
}

}  // namespace
}  // namespace limpid
