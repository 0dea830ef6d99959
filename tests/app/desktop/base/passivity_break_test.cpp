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
  account.follow(history, history.end());
  return account.without_limits();
}

TEST(PassivityBreak, MakesTheLoopGiveEnergyUntilItEnds) {
  const ArmDescription arm = test::omni();
  Settings s;
  s.parameters = {};
  EXPECT_FALSE(passivity_broken(s));
  break_passivity(s, arm);
  EXPECT_TRUE(passivity_broken(s));
  EXPECT_LT(s.parameters.eta,
            analyze(arm, rest_pose(arm), s.parameters, std::nullopt).eta_min_grip);
  EXPECT_GT(given_while_held(s.parameters), 1e-2) << "ten times what the panel calls a fault";
  end_passivity_break(s);
  EXPECT_FALSE(passivity_broken(s));
  EXPECT_LT(given_while_held(s.parameters), 1e-3);
}

// The predictive law holds in the grip in which the proposed one gives energy.
TEST(PassivityBreak, IsMendedByThePredictiveLawToo) {
  Parameters p = without_passivity(Parameters{}, test::omni());
  p.kind = CouplingKind::predictive;
  EXPECT_LT(given_while_held(p), 1e-3);
}

Settings of_a_twin(bool edited) {
  Settings s;
  s.parameters.kind = CouplingKind::standard;
  s.parameters.eta = 2;
  s.parameters.hand_stiffness = 123;
  s.parameters.hand_damping = 4;
  s.twin.on = true;
  s.twin.edited = edited;
  s.twin.parameters.kind = CouplingKind::predictive;
  s.twin.parameters.eta = 0.4;
  s.twin.parameters.hand_stiffness = 123;
  s.twin.parameters.hand_damping = 4;
  return s;
}

TEST(PassivityBreak, PutsEverythingOfBothRunsBackWhateverWasMovedMeanwhile) {
  for (const bool twin : {false, true}) {
    const Settings before = of_a_twin(twin);
    Settings s = before;
    break_passivity(s, test::omni());
    Parameters& run = twin ? s.twin.parameters : s.parameters;
    EXPECT_EQ(run.kind, CouplingKind::proposed);
    EXPECT_EQ(s.parameters.hand_stiffness, 3000) << "one hand holds both";
    EXPECT_EQ(s.twin.parameters.hand_stiffness, 3000);
    EXPECT_EQ(twin ? s.parameters.kind : s.twin.parameters.kind,
              twin ? before.parameters.kind : before.twin.parameters.kind);
    run.alpha = 0.02;
    run.eta = 0.3;
    s.parameters.hand_mass = 0.1;
    break_passivity(s, test::omni());  // like another press of the button
    end_passivity_break(s);
    EXPECT_TRUE(s.parameters == before.parameters);
    EXPECT_TRUE(s.twin.parameters == before.twin.parameters);
  }
}

TEST(PassivityBreak, EndsWithTheLawThatIsChosenInItsPlace) {
  for (const bool twin : {false, true}) {
    const Settings before = of_a_twin(twin);
    Settings s = before;
    break_passivity(s, test::omni());
    EXPECT_FALSE(end_break_by_law(s));
    Parameters& run = twin ? s.twin.parameters : s.parameters;
    run.eta = 0.3;
    EXPECT_FALSE(end_break_by_law(s)) << "its limit may be looked for";
    run.kind = CouplingKind::predictive;
    EXPECT_TRUE(end_break_by_law(s));
    EXPECT_FALSE(passivity_broken(s));
    EXPECT_EQ(run.kind, CouplingKind::predictive);
    run.kind = twin ? before.twin.parameters.kind : before.parameters.kind;
    EXPECT_TRUE(s.parameters == before.parameters);
    EXPECT_TRUE(s.twin.parameters == before.twin.parameters);
  }
}

}  // namespace
}  // namespace limpid
