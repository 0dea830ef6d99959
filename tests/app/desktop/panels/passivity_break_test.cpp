#include "app/desktop/panels/passivity_break.h"

#include <gtest/gtest.h>

#include "app/run/analysis.h"
#include "app/session/energy_account.h"
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
  simulate(plan, {}, [&](std::span<const double> row, const Parameters*) {
    channels.append(history, row);
    return true;
  });
  EnergyAccount account;
  account.follow(history, history.end());
  return account.without_limits();
}

TEST(PassivityBreak, MakesTheLoopGiveEnergyAndRepairEndsThat) {
  const ArmDescription arm = test::omni();
  Parameters p;
  PassivityBreak one;
  EXPECT_FALSE(one.broken(p));
  one.break_it(p, arm);
  EXPECT_TRUE(one.broken(p));
  EXPECT_LT(p.eta, analyze(arm, rest_pose(arm), p, std::nullopt).eta_min_grip);
  EXPECT_GT(given_while_held(p), 1e-2) << "ten times what the panel calls a fault";
  one.repair(p);
  EXPECT_FALSE(one.broken(p));
  EXPECT_LT(given_while_held(p), 1e-3);
}

// The predictive law holds in the grip in which the proposed one gives energy.
TEST(PassivityBreak, IsMendedByThePredictiveLawToo) {
  Parameters p = without_passivity(Parameters{}, test::omni());
  p.kind = CouplingKind::predictive;
  EXPECT_LT(given_while_held(p), 1e-3);
}

TEST(PassivityBreak, RepairGivesBackLawInertiaAndGripAndNothingElse) {
  Parameters before;
  before.kind = CouplingKind::standard;
  before.eta = 2;
  before.hand_stiffness = 123;
  before.hand_damping = 4;
  Parameters p = before;
  PassivityBreak one;
  one.break_it(p, test::omni());
  p.alpha = 0.02;  // moved meanwhile
  one.repair(p);
  EXPECT_EQ(p.alpha, 0.02);
  p.alpha = before.alpha;
  EXPECT_TRUE(p == before);
}

TEST(PassivityBreak, IsOverOnceOneOfItsSettingsIsAnother) {
  Parameters p;
  PassivityBreak one;
  one.break_it(p, test::omni());
  p.kind = CouplingKind::predictive;  // as C does
  EXPECT_FALSE(one.broken(p));
}

}  // namespace
}  // namespace limpid
