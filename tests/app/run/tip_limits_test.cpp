#include "app/run/tip_limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/run/simulate.h"
#include "core/dynamics/arm.h"
#include "tests/support/built_in.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

TipLimits limits(const Parameters& p, const Scene& scene = {}) {
  const ArmDescription arm = test::omni();
  return tip_limits(arm, rest_pose(arm), p, scene);
}

double wall(const TipLimits& l, CouplingKind kind) { return l.wall(kind).stiffness; }

// Expects a recommended stiffness that is stable, and cautious by a factor at most: up to the one
// that `experiment zwidth` finds.
void expect_named(const Parameters& p, double found) {
  const double named = wall(limits(p), CouplingKind::predictive);
  EXPECT_LE(named, found);
  EXPECT_GE(named, found / 5);
}

TEST(TipLimits, OfTheStandardLawAreNoneWhereItGivesEnergyAlready) {
  using enum CouplingKind;
  Parameters p;
  EXPECT_GT(wall(limits(p), standard), 100);
  p.link_delay = 20;
  EXPECT_EQ(wall(limits(p), standard), 0);
  EXPECT_GT(wall(limits(p), tank), 100) << "which is passive through a link";
  p.link_loss = 0.1;
  const TipLimits lossy = limits(p);
  EXPECT_EQ(wall(lossy, standard), 0);
  EXPECT_NE(lossy.wall(standard).bound.find("packets are lost"), std::string::npos);
  p.link_loss = 0;
  p.link_delay = 0;
  p.tick = 0.1;
  EXPECT_EQ(wall(limits(p), standard), 0);
}

TEST(TipLimits, OfThePredictiveLawFallByWhatItDoesNotKnow) {
  using enum CouplingKind;
  const Parameters exact;
  EXPECT_GE(wall(limits(exact), predictive), 10000);
  Parameters heavy, late;
  heavy.hand_mass_at_tip = 0.5;
  heavy.hand_mass = 0.05;
  EXPECT_LT(wall(limits(heavy), predictive), wall(limits(exact), predictive));
  heavy.hand_mass = 0.5;  // the law knows the mass
  EXPECT_EQ(wall(limits(heavy), predictive), wall(limits(exact), predictive));
  late.device_delay = 1;
  EXPECT_LT(wall(limits(late), predictive), 5000);
  late.delay = 1;
  expect_named(late, 3500);
  late.encoder_step = 1e-4;
  expect_named(late, 2300);
  late.device_delay = late.delay = 5;
  EXPECT_LE(wall(limits(late), predictive), 100);
}

// Devices that people own, as the theory of encoder steps has them: 0.25 N for a step, 5 mm/s
// inside a cell, friction over half a step.
TEST(TipLimits, OfThePredictiveLawCountStepsAndFriction) {
  const auto named = [](const char* file, double step, double friction) {
    const ArmDescription arm = read_urdf(test::assets_dir() / "devices" / file);
    Parameters p;
    p.encoder_step = step;
    p.friction = friction;
    return tip_limits(arm, rest_pose(arm), p, {}).wall(CouplingKind::predictive);
  };
  const auto expect = [](const TipWall& wall, double stiffness, const char* bound) {
    EXPECT_NEAR(wall.stiffness / stiffness, 1, 0.1) << wall.bound;
    EXPECT_TRUE(wall.bound.starts_with(bound)) << wall.bound;
  };
  expect(named("touch.urdf", 4.19e-4, kFromArm), 0.25 / 9.2e-5, "at this wall an encoder step");
  expect(named("touch.urdf", 4.19e-4, 0), 0.036 * std::pow(5e-3 / 0.6 / 9.2e-5, 2),
         "the tip can swing inside an encoder step");
  expect(named("touch.urdf", 4.19e-4, 0.02), 2 * (0.02 / 0.191) / 9.2e-5, "0.1 N of friction");
  expect(named("omni.urdf", 4.19e-4, kFromArm), 0.036 / 5 * std::pow(5e-3 / 0.6 / 9.2e-5, 2),
         "the tip can swing inside an encoder step");
  expect(named("falcon.urdf", 3.84e-4, kFromArm), 6500, "at this wall an encoder step");
  for (const char* file : {"omega.urdf", "inverse3.urdf"}) {
    expect(named(file, 1e-4, kFromArm), 10000, "no stiffer wall was tested with encoder steps");
  }
  EXPECT_NE(named("touch.urdf", 4.19e-4, 0).bound.find("0.26 N of friction the wall may have 27"),
            std::string::npos)
      << named("touch.urdf", 4.19e-4, 0).bound;
}

// Friction that the motors take off no longer holds the tip.
TEST(TipLimits, DoNotCountFrictionThatIsTakenOff) {
  const ArmDescription arm = read_urdf(test::assets_dir() / "devices/touch.urdf");
  Parameters p;
  p.encoder_step = 4.19e-4;
  p.friction = 0.02;
  const auto wall_with = [&](double share) {
    p.friction_share = share;
    return wall(tip_limits(arm, rest_pose(arm), p, {}), CouplingKind::predictive);
  };
  EXPECT_NEAR(wall_with(0.5), wall_with(0) / 2, 1e-6 * wall_with(0));
}

TEST(TipLimits, OfThePapersLawsAreItsSpringAndItsLag) {
  Parameters p;
  const TipLimits l = limits(p);
  EXPECT_NEAR(wall(l, CouplingKind::standard), p.k_vc / l.tip.lever2, 1e-9);
  p.eta = 0.5;
  EXPECT_NEAR(wall(limits(p), CouplingKind::proposed), 0.5 * wall(l, CouplingKind::proposed), 1e-9);
  EXPECT_NEAR(l.every_hand, 2 * 0.012 / l.tip.lever2 / p.tick, 1e-9);
}

TEST(TipLimits, ReckonWithTheDeviceAsItWasMeasured) {
  ArmDescription arm = test::omni();
  arm.delay = 0.0016;
  const TipLimits unknown = tip_limits(arm, rest_pose(arm), {}, {});
  EXPECT_EQ(unknown.loop.delay, 0.0016);
  EXPECT_NEAR(unknown.every_hand, limits({}).every_hand * 0.5 / 2.1, 1e-9);
  const double foreseen = wall(unknown, CouplingKind::predictive);
  EXPECT_LE(foreseen, 1400) << "it does not reckon with it";
  EXPECT_GE(foreseen, 500);
  Parameters p;
  p.delay = 2;
  const TipLimits known = tip_limits(arm, rest_pose(arm), p, {});
  EXPECT_LE(wall(known, CouplingKind::predictive), 1000);
  EXPECT_GE(wall(known, CouplingKind::predictive), 300);
}

TEST(TipLimits, KnowTheStiffestThingOfTheScene) {
  Scene scene;
  EXPECT_EQ(limits({}, scene).scene, 0);
  scene.add({.shape = Plane{}, .material = {600}});
  scene.add({.shape = Sphere{}, .material = {5000}});
  scene.add({.shape = JointStop{}, .material = {6000}});  // [N m/rad]
  EXPECT_EQ(limits({}, scene).scene, 5000);
}

TEST(TipLimits, FeelInertiaAsEachLawMakesIt) {
  Parameters p;
  p.eta = 0.4;
  const TipLimits l = limits(p);
  const double m = l.felt.m;
  EXPECT_NEAR(felt_at_tip(CouplingKind::predictive, p, l, 2).mass, 0.4 * m, 0.03 * m);
  EXPECT_GT(felt_at_tip(CouplingKind::standard, p, l, 2).mass, 0.9 * m);
  EXPECT_GT(felt_at_tip(CouplingKind::predictive, p, l, 0.5).damping,
            l.felt.least_damping(p.eta, p.band));
}

TEST(TipLimits, SayWhatDelayAndProxyLeaveOfEta) {
  Parameters p;
  const auto said = [&] { return less_added_text(limits(p), p); };
  p.eta = 5;
  EXPECT_EQ(said(), "");
  p.device_delay = 3;
  EXPECT_EQ(said(), "5 up to 3.3 Hz, because the torque may be 3 ms late");
  p.device_delay = 0;
  p.inertia_ratio = 0.5;
  EXPECT_EQ(said(), "2 up to 25 Hz, because the proxy has 0.5 times the device's inertia");
  p.eta = 2;
  EXPECT_EQ(said(), "");
  p.eta = 0.5;
  EXPECT_EQ(said(), "");
}

// In ten seconds on the table more added mass lets device and proxy swing.
TEST(TipLimits, BoundTheMassAddedBesideAHeavyProxy) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 10);
  plan.parameters.kind = CouplingKind::predictive;
  plan.parameters.eta = 5;
  plan.parameters.inertia_ratio = 0.5;
  plan.parameters.hand_mass_at_tip = 0.05;
  const RowLayout layout = plan.layout();
  double highest = 0;
  simulate(plan, {}, [&](std::span<const double> row, LaneChanges) {
    highest = std::max(highest, layout.in(row, Column::energy_total)[0]);
    return true;
  });
  EXPECT_LE(highest, 0.05e-3);
}

}  // namespace
}  // namespace limpid
