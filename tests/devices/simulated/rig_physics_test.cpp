// Promises of the paper in the full nonlinear loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/coupling/eta_min.h"
#include "core/dynamics/arm.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/rows.h"

namespace limpid {
namespace {

using test::Rows;

const Vec3 kAboveTable(0.19, 0, 0);
constexpr double kTableTop = -0.04;

// Rows of a hand that goes from kAboveTable to `depth` below the table top in a second and stays
// `rest` seconds.
Rows press_table(const Parameters& p, double depth, double rest) {
  const ArmDescription arm = test::omni();
  Rig rig(arm, test::omni_scene("table.toml"));
  rig.start(p, rest_at(arm, kAboveTable));
  Rows rows(rig.layout());
  const auto ticks = static_cast<std::size_t>((1 + rest) / p.tick);
  for (std::size_t k = 0; k < ticks; ++k) {
    const double s = std::min(1.0, static_cast<double>(k) * p.tick);
    const double smooth = s * s * (3 - 2 * s);
    const Vec3 target(kAboveTable.x(), kAboveTable.y(), smooth * (kTableTop - depth));
    rig.step(p, {{target, 1}}, rows.add());
  }
  return rows;
}

// Rows of a hand that follows a recorded path.
Rows follow(const Parameters& p, const Scene& scene, const HandPath& hand) {
  const ArmDescription arm = test::omni();
  Rig rig(arm, scene);
  rig.start(p, rest_at(arm, hand.at(0)));
  Rows rows(rig.layout());
  const auto ticks = static_cast<std::size_t>(hand.duration() / p.tick);
  for (std::size_t k = 0; k < ticks && !rig.diverged(); ++k) {
    rig.step(p, {{hand.sample(k, p.tick), 1}}, rows.add());
  }
  return rows;
}

struct SettledPress {
  double contact, error;  // |f2| [N m], |x_E| [rad]
};
SettledPress settled(const Rows& rows) {
  const std::size_t last = rows.size() - 1;
  const Eigen::VectorXd x_E =
      rows.vec(last, Column::device_position) - rows.vec(last, Column::proxy_position);
  return {rows.vec(last, Column::contact_torque).norm(), x_E.norm()};
}

TEST(CoordinationError, GrowsByOneOverTheSpringWithTheStandardCoupling) {
  Parameters p;
  p.kind = CouplingKind::standard;
  for (const double k_vc : {5.0, 10.0}) {
    p.k_vc = k_vc;
    const SettledPress light = settled(press_table(p, 0.002, 3)),
                       hard = settled(press_table(p, 0.006, 3));
    ASSERT_GT(hard.contact, light.contact + 0.02);
    const double slope = (hard.error - light.error) / (hard.contact - light.contact);
    EXPECT_NEAR(slope, 1 / k_vc, 1e-4 / k_vc);
  }
}

TEST(CoordinationError, DoesNotGrowWithTheContactWithTheProposedCoupling) {
  for (const double eta : {0.7, 1.0, 3.0}) {
    Parameters p;
    p.eta = eta;
    const SettledPress light = settled(press_table(p, 0.002, 3)),
                       hard = settled(press_table(p, 0.006, 3));
    ASSERT_GT(hard.contact, light.contact + 0.02);
    const double slope = (hard.error - light.error) / (hard.contact - light.contact);
    EXPECT_LT(std::abs(slope), 1e-3) << eta;  // a hundredth of 1/k_vc
  }
}

TEST(CoordinationError, StaysSmallInMotionWithTheProposedCoupling) {
  const auto largest = [](const Rows& rows) {
    double error = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      error = std::max(
          error,
          (rows.vec(k, Column::device_position) - rows.vec(k, Column::proxy_position)).norm());
    }
    return error;
  };
  Parameters p;
  const Scene scene = test::omni_scene("table.toml");
  const HandPath hand = test::hand("touch.csv");
  const double proposed = largest(follow(p, scene, hand));
  p.kind = CouplingKind::standard;
  EXPECT_LT(proposed, 0.25 * largest(follow(p, scene, hand)));
  for (const double error : {0.5, 2.0}) {  // with the model's inertia wrong
    Parameters wrong;
    wrong.inertia_error = error;
    EXPECT_LT(largest(follow(wrong, scene, hand)), 2 * proposed);
  }
}

TEST(HumanTorque, OfTheSameFreeMotionIsProportionalToEta) {
  const Scene nothing;
  const HandPath hand = test::hand("free.csv");
  const auto effort = [&](double eta) {
    Parameters p;
    p.eta = eta;
    p.hand_stiffness = 3000;  // gives all the same motion
    const Rows rows = follow(p, nothing, hand);
    double sum = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      sum += rows.vec(k, Column::hand_torque).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(rows.size()));
  };
  const double full = effort(1);
  EXPECT_NEAR(effort(5) / full, 5, 0.5);
  EXPECT_NEAR(effort(0.7) / full, 0.7, 0.07);
}

TEST(ControllerEnergy, OfAStableLoopIsNeverProduced) {
  for (const char* name : {"touch.csv", "free.csv", "proximal.csv"}) {
    const HandPath hand = test::hand(name);
    const Scene scene =
        test::omni_scene(name == std::string("proximal.csv") ? "proximal.toml" : "table.toml");
    for (const double eta : {-1.0, 0.6, 1.0, 5.0}) {
      Parameters p;
      if (eta < 0) {
        p.kind = CouplingKind::standard;
      } else {
        p.eta = eta;
      }
      const Rows rows = follow(p, scene, hand);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        ASSERT_LE(rows.at(k, Column::energy_total), 1e-4)
            << name << ", eta " << eta << ", row " << k;
      }
    }
  }
}

TEST(ForceEstimate, DoesNotWindUpInASaturatedContactIfItIsFedWhatTheMotorsGave) {
  const auto off = [](bool anti_windup) {
    Parameters p;
    p.torque_limit = 0.05;
    p.anti_windup = anti_windup;
    const Rows rows = press_table(p, 0.02, 3);
    const std::size_t last = rows.size() - 1;
    const Eigen::VectorXd f1 = rows.vec(last, Column::hand_torque);
    const Eigen::VectorXd command = rows.vec(last, Column::commanded_torque);
    EXPECT_GT(command.cwiseAbs().maxCoeff(), 0.05);  // the motor was at its limit
    return (rows.vec(last, Column::hand_torque_estimate) - f1).norm() / f1.norm();
  };
  EXPECT_LT(off(true), 0.01);
  EXPECT_GT(off(false), 0.5);
}

TEST(ForceEstimate, OfAStaticPressIsTheHandsTorque) {
  const Rows rows = press_table(Parameters{}, 0.003, 3);
  const std::size_t last = rows.size() - 1;
  const Eigen::VectorXd f1 = rows.vec(last, Column::hand_torque);
  const Eigen::VectorXd f1_hat = rows.vec(last, Column::hand_torque_estimate);
  EXPECT_GT(f1.norm(), 0.05);
  EXPECT_LT((f1_hat - f1).norm(), 1e-3 * f1.norm());
  EXPECT_LT((f1 + rows.vec(last, Column::contact_torque)).norm(), 1e-3 * f1.norm());
}

constexpr double kStiffGrip = 3000;  // [N/m]

// Growth of a nudged swing in a hand of pure stiffness: its speed after three seconds over its
// first.
double growth(double eta) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.eta = eta;
  p.hand_stiffness = kStiffGrip;
  p.hand_damping = 0;
  p.torque_limit = 100;
  Rig rig(arm, Scene{});
  rig.start(p, rest_at(arm, kAboveTable));
  Rows rows(rig.layout());
  double early = 0, late = 0;
  for (std::size_t k = 0; k < 3000; ++k) {
    const double nudge = k < 20 ? 1e-4 : 0;
    rig.step(p, {{kAboveTable + Vec3(nudge, nudge, nudge), 1}}, rows.add());
    const double speed = rows.vec(k, Column::device_velocity).norm();
    if (k < 500) early = std::max(early, speed);
    if (k >= 2500) late = std::max(late, speed);
  }
  return late / early;
}

TEST(EtaMin, OfAStiffUndampedGripIsWhereTheLoopTurnsUnstable) {
  const ArmDescription description = test::omni();
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  Mat<kAnyDof> M;
  Jacobian<kAnyDof> J;
  arm.frames(rest_at(description, kAboveTable).x1, f);
  arm.inertia(f, M);
  arm.point_jacobian(f, 2, kAboveTable, J);
  const Parameters p;
  const Eigen::MatrixXd K = kStiffGrip * J.transpose() * J;
  const double limit = eta_min_grip((1 + p.inertia_ratio) * M, Eigen::VectorXd::Constant(3, 0.024),
                                    p.alpha, K, Eigen::MatrixXd::Zero(3, 3));
  EXPECT_NEAR(limit, 0.56, 0.03);
  // The theory ignores sampling, which costs a little.
  EXPECT_LT(growth(1.1 * limit), 0.1);
  EXPECT_GT(growth(0.97 * limit), 10);
}

TEST(Loop, ThatIsUnstableSaysSoAndGivesNoMoreTorque) {
  // A spring too stiff for a tick of 10 ms, and motors without limits.
  const ArmDescription arm = test::omni();
  Parameters p;
  p.k_vc = 1e4;
  p.tick = 0.01;
  p.torque_limit = 1e4;
  p.hand_stiffness = 0;
  Rig rig(arm, Scene{});
  rig.start(p, rest_at(arm, kAboveTable));
  Rows rows(rig.layout());
  std::size_t k = 0;
  for (; k < 20000 && !rig.diverged(); ++k) {
    rig.step(p, {{kAboveTable + Vec3(0.01, 0.01, 0.01), 1}}, rows.add());
  }
  ASSERT_TRUE(rig.diverged()) << rows.vec(k - 1, Column::device_velocity).norm();
  for (int i = 0; i < 10; ++i) {
    rig.step(p, {{kAboveTable, 1}}, rows.add());
    EXPECT_EQ(rows.vec(rows.size() - 1, Column::motor_torque).norm(), 0);
  }
  EXPECT_EQ(rows.vec(k - 1, Column::motor_torque).norm(), 0);
}

}  // namespace
}  // namespace limpid
