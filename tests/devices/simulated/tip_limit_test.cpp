// The limit of force at the tip of a real device, under laws that take the motors' limits into
// account.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/dynamics/torque_limits.h"
#include "devices/simulated/random_corner.h"
#include "tests/support/built_in.h"
#include "tests/support/guarded_arm.h"
#include "tests/support/random_arm.h"
#include "tests/support/rows.h"
#include "tests/support/singular_values.h"
#include "tests/support/table.h"

namespace limpid {
namespace {

using test::kTable;

struct TipOutcome {
  double energy = 0;           // highest E_c, from torques and positions [J]
  double given = 0;            // most energy given to the hand since the start [J]
  double reserve = 1, at = 0;  // lowest, and at the end [J]
  double contact = 0;          // share of the contact force at the end [-]
  double force = 0;            // largest force at the tip [N]
  int unsettled = 0, limited = 0;
  Vec3 tip = Vec3::Zero();  // place of the device's tip at the end [m]
};

class PressedRig {
 public:
  PressedRig(const ArmDescription& arm, const Scene& scene, const Parameters& parameters,
             double tip_force)
      : device(arm), rig(arm, scene, &device), rows(rig.layout()), model(arm), p(parameters) {
    rig.limit({.tip_force = tip_force});
    for (int i = 0; i < 3; ++i) damping_[i] = arm.joints[static_cast<std::size_t>(i)].damping;
  }
  void start(const RigStart& at) {
    rig.start(p, at);
    x_ = device.own.arm.x();
    step(at.target, ForceRequest::arm);
    for (int k = 0; k < 600; ++k) step(at.target);
  }
  void step(const Vec3& target, ForceRequest force = ForceRequest::as_it_is) {
    rig.step(p, {.hand = {target, 1}, .force = force}, rows.add());
    const std::size_t k = rows.size() - 1;
    const Vec<3> tau1 = rows.vec(k, Column::motor_torque);
    const Vec<3> x = device.own.arm.x(), dx = x - x_;
    x_ = x;
    const double given = tau1.dot(dx) - dx.dot(damping_.cwiseProduct(dx)) / p.tick;
    port_ += given;
    energy_ += given;
    // The proxy's part is known a tick later.
    if (k > 0) {
      const Vec<3> dx2 =
          rows.vec(k, Column::proxy_position) - rows.vec(k - 1, Column::proxy_position);
      energy_ += rows.vec(k - 1, Column::proxy_torque).dot(dx2);
    }
    all.energy = std::max(all.energy, energy_);
    all.given = std::max(all.given, port_);
    if (k > 1) all.reserve = std::min(all.reserve, rows.at(k, Column::energy_ledger));
    all.at = rows.at(k, Column::energy_ledger);
    all.contact = rows.at(k, Column::governor);
    all.unsettled = static_cast<int>(rows.at(k, Column::unsettled));
    all.limited += rows.at(k, Column::solved) == 1;
    all.force = std::max(all.force, force_of(tau1, x));
    all.tip = model.tip_at(x);
  }
  double force_of(const Vec<3>& tau, const Vec<3>& x) const {
    Arm<3>::Frames frames;
    model.frames(x, frames);
    Jacobian<3> J;
    model.point_jacobian(frames, 2, model.tip(frames), J);
    return tip_force<3>(tau, J);
  }
  double force() const { return force_of(rows.vec(rows.size() - 1, Column::motor_torque), x_); }
  TipOutcome all;
  test::GuardedArm device;
  Rig rig;
  test::Rows rows;

 private:
  Vec<3> damping_;  // of the joints by their file [N m s/rad]
  Arm<3> model;
  Parameters p;
  Vec<3> x_;
  double energy_ = 0, port_ = 0;
};

// A hand presses into a wall with 4 N, then with 1 N.
struct WallPress {
  double tip = 1.5, K = 3000;  // [N, N/m]
  double eta = 1, torque_limit = kFromArm;
  double grip = 300, damping = 2;  // [N/m, N s/m]
  bool rubs = false;
  CouplingKind kind = CouplingKind::predictive;

  struct Both {
    TipOutcome all;
    double deep, end;  // depth of the tip in the wall when pressed with 4 N and 1 N [m]
    double force;      // force at the tip at the end [N]
    double given;      // most energy to the hand, until it presses with 1 N [J]
  };
  Both run() const {
    const ArmDescription arm = test::omni();
    const double friction = rubs ? 0.3 : 0;
    Parameters p;
    p.kind = kind;
    p.eta = eta;
    p.hand_stiffness = grip;
    p.hand_damping = damping;
    p.torque_limit = torque_limit;
    PressedRig run(arm, test::table({K, 0, friction, friction}), p, tip);
    run.start(rest_at(arm, kTable + Vec3(0, 0, 0.005)));
    double now = 0;
    const auto go = [&](double newton, double seconds) {
      for (int k = 0; k < seconds * 1e3; ++k) {
        now += std::clamp(newton - now, -0.02, 0.02);
        const Vec3 along = rubs ? Vec3(0.01 * std::sin(2e-3 * k), 0.02 * std::sin(5e-3 * k), 0)
                                : Vec3(0, 2e-5 * std::sin(0.1 * k), 0);
        run.step(kTable + along - Vec3(0, 0, now / grip + now / K));
      }
      return kTable.z() - run.all.tip.z();
    };
    const double deep = go(4, 2), given = run.all.given, end = go(1, 5);
    return {run.all, deep, end, run.force(), given};
  }
  // Depth of rest of a hand that presses with `newton`, if the motors give at most `most` [m, N].
  double depth(double newton, double most) const {
    const double whole = newton / grip + newton / K;
    return newton <= most ? newton / K : whole - most / grip;
  }
  friend std::ostream& operator<<(std::ostream& out, const WallPress& p) {
    return out << "tip " << p.tip << " N, K " << p.K << " N/m, eta " << p.eta << ", joints "
               << p.torque_limit << " N m, grip " << p.grip << " N/m, " << p.damping << " N s/m, "
               << (p.rubs ? "rubs, " : "") << name(p.kind);
  }
};

// E_c, the hand's energy and the reserve are those that core/README.md states without such a limit.
TEST(TipLimit, IsKnownToThePredictiveLawWhichLosesNoReserveToIt) {
  for (const bool rubs : {false, true}) {
    for (const double tip : {0.2, 0.5, 0.7, 1.5, 3.0}) {
      for (const double K : {1000.0, 3000.0}) {
        const WallPress press{.tip = tip, .K = K, .rubs = rubs};
        SCOPED_TRACE(testing::Message() << press);
        const WallPress::Both found = press.run();
        EXPECT_LE(found.all.energy, 0.05e-3);
        EXPECT_LE(found.all.given, 0.05e-3);
        EXPECT_GT(found.all.reserve, 3e-3);
        EXPECT_LE(found.all.force, 1.005 * tip);
        EXPECT_GT(found.all.limited, 1000) << "it was pressed harder than that";
        EXPECT_EQ(found.all.unsettled, 0);
        EXPECT_GT(found.all.contact, 0.99) << "the wall is as stiff as it is set to";
        const double off = rubs ? 0.6e-3 : 0.02e-3;
        EXPECT_NEAR(found.deep, press.depth(4, tip), off);
        EXPECT_NEAR(found.end, press.depth(1, tip), off);
        EXPECT_NEAR(found.force, std::min(tip, 1.0), rubs ? 0.2 : 0.01);
      }
    }
  }
}

// Grips without damping leave the account with a debt that no motion pays, as no book has the
// damping of a real device.
TEST(TipLimit, LeavesNoDebtThatAHandAtRestCannotPay) {
  for (const double tip : {1.5, 10.0}) {
    for (const double limit : {kFromArm, 0.28}) {
      for (const double eta : {1.0, 0.3}) {
        for (const double grip : {300.0, 1000.0, 3000.0}) {
          for (const double damping : {0.0, 2.0}) {
            const WallPress press{
                .tip = tip, .eta = eta, .torque_limit = limit, .grip = grip, .damping = damping};
            SCOPED_TRACE(testing::Message() << press);
            const WallPress::Both found = press.run();
            EXPECT_NEAR(found.end, 1 / press.K, 0.1e-3) << "force has come back";
            EXPECT_GT(found.all.at, 1e-3);
            EXPECT_LE(found.given, 5e-3) << "until it rests";
          }
        }
      }
    }
  }
}

// The motors' force changes its direction while the proxy slides along the wall; the account must
// not take that for energy.
TEST(TipLimit, KeepsItsForceHoweverDeepItIsPressed) {
  std::mt19937 random(8);
  const auto between = [&](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (unsigned seed = 0; seed < 160; ++seed) {
    ArmDescription arm = seed == 0 ? test::omni() : test::random_arm(3, seed);
    for (Joint& joint : arm.joints) joint.effort = 5;
    const double force = between(1, 10), grip = between(300, 800), K = between(600, 3000);
    const Vec3 in = Vec3(between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
    const Vec3 at = rest_tip(arm);
    const Arm<3> model(arm);
    Arm<3>::Frames frames;
    model.frames(rest_pose(arm), frames);
    Jacobian<3> J;
    model.point_jacobian(frames, 2, at, J);
    constexpr double kLever = 0.05;  // least of the tip in any direction [m]
    if (test::singular_values(J)[0] < kLever) continue;
    Object wall;
    wall.shape = Plane{-in};
    wall.pose = pose_at(at + 0.005 * in);
    wall.material = {K, 0, 0, 0};
    Scene scene;
    scene.add(wall);
    Parameters p;
    p.kind = CouplingKind::predictive;
    p.hand_stiffness = grip;
    p.hand_damping = 5;
    PressedRig run(arm, scene, p, force);
    run.start(rest_at(arm, at));
    const double deep = 0.005 + 2.5 * force / grip;  // the hand alone: 2.5 of the limit [m]
    const auto go = [&](double from, double to, int ticks) {
      for (int k = 0; k < ticks; ++k) run.step(at + (from + (to - from) * k / ticks) * in);
    };
    go(0, deep, 3000);
    go(deep, deep, 2000);
    SCOPED_TRACE(testing::Message() << seed << ": " << force << " N, grip " << grip << ", K " << K);
    EXPECT_GT(run.force(), 0.98 * std::min(force, grip * deep / (1 + grip / K)));
    EXPECT_GT(run.all.limited, 1000);
    EXPECT_GT(run.all.contact, 0.99);
    EXPECT_GT(run.all.reserve, 1e-3);
    go(deep, 0, 1500);
    EXPECT_LE(run.all.given, 0.05e-3);
    EXPECT_LE(run.all.energy, 0.05e-3);
  }
}

TEST(TipLimit, LeavesTheTanksAsTheyAre) {
  for (const double tip : {0.2, 0.7, 1.5, 3.0}) {
    const WallPress press{.tip = tip, .kind = CouplingKind::tank};
    SCOPED_TRACE(testing::Message() << press);
    const WallPress::Both found = press.run();
    EXPECT_LE(found.all.energy, 0.05e-3);
    EXPECT_LE(found.all.given, 0.05e-3);
    EXPECT_GT(found.all.reserve, 3e-3);
    EXPECT_LE(found.all.force, 1.005 * tip);
  }
}

// Random corners of planes: the limit makes them no worse.
TEST(TipLimit, MakesNoEnergyBetweenWalls) {
  const auto worst = [](bool limited) {
    TipOutcome all;
    for (unsigned seed = 0; seed < 60; ++seed) {
      LimitedCorner c = limited_corner(seed, {}, test::omni());
      c.p.torque_limit = kFromArm;
      const double tip = limited ? 0.2 * std::pow(15, (seed % 10) / 9.0) : 10;
      PressedRig run(c.arm, c.scene, c.p, tip);
      run.start(c.start);
      for (int k = 0; k < LimitedCorner::kLasts * 1e3; ++k) run.step(c.hand(1e-3 * k));
      EXPECT_LE(run.all.force, 1.005 * tip) << seed;
      if (limited) {
        EXPECT_LE(run.all.given, 5e-3) << seed;
      }
      all.energy = std::max(all.energy, run.all.energy);
      all.reserve = std::min(all.reserve, run.all.reserve);
      all.unsettled += run.all.unsettled;
    }
    return all;
  };
  const TipOutcome with = worst(true), without = worst(false);
  EXPECT_LE(with.energy, without.energy);
  EXPECT_GE(with.reserve, without.reserve);
  EXPECT_EQ(with.unsettled, 0);
}

// The force that measures a grip: whatever is asked, a real device gets no more than the tip's
// limit, nothing from the report of a cut on, and from nothing again when it is armed.
TEST(TipLimit, HoldsForTheForceThatMeasuresAGrip) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.kind = CouplingKind::predictive;
  constexpr double kTip = 1.5;  // [N]
  PressedRig one(arm, Scene{}, p, kTip);
  const Vec3 target = rest_tip(arm);
  const Eigen::VectorXd rest = rest_pose(arm), zero = Eigen::VectorXd::Zero(3);
  const RigStart at{rest, zero, rest, zero, zero, target};
  one.start(at);
  const auto told = [&](ForceRequest force) {
    const Vec3 asked(-20, 14, 20);  // [N]
    one.rig.step(p, {.hand = {target, 1}, .force = force, .excitation = asked}, one.rows.add());
    return one.force_of(Vec<3>(one.device.told.data()), one.device.own.arm.x());
  };
  double most = 0;
  for (int k = 0; k < 30; ++k) most = std::max(most, told(ForceRequest::as_it_is));
  EXPECT_GT(most, 0.9 * kTip) << "it pushes";
  EXPECT_LT(most, 1.01 * kTip);
  EXPECT_EQ(told(ForceRequest::cut), 0);
  for (int k = 0; k < 300; ++k) ASSERT_EQ(told(ForceRequest::as_it_is), 0) << k;
  EXPECT_LT(told(ForceRequest::arm), 0.02 * kTip);
}

}  // namespace
}  // namespace limpid
