#include <gtest/gtest.h>

#include "app/run/analysis.h"
#include "core/coupling/eta_min.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

Eigen::MatrixXd scalar(double x) { return Eigen::MatrixXd::Constant(1, 1, x); }
Eigen::VectorXd damping(double b) { return Eigen::VectorXd::Constant(1, b); }

TEST(GripLimit, IsRouthsOfTheLockedSystemWhenTheCouplingIsRigid) {
  Parameters p;
  p.k_vc = 1e4;
  for (const double grip : {1.0, 20.0, 500.0}) {
    const double locked = eta_min_grip(LockedMode{2e-4, 0.012 + p.b_v, p.alpha}, grip, 0);
    EXPECT_NEAR(eta_min_compliant(scalar(2e-4), damping(0.012), p, scalar(grip), scalar(0)), locked,
                1e-4);
  }
}

TEST(GripLimit, TendsTo25WithTheDevicesDampingAloneInAStiffGrip) {
  Parameters p;
  p.b_vc = 0;
  const double alone = eta_min(LockedMode{2e-4, 0.012, p.alpha});
  EXPECT_NEAR(eta_min_compliant(scalar(2e-4), damping(0.012), p, scalar(1e5), scalar(0)), alone,
              2e-3);
}

TEST(GripLimit, OfJointsThatShareNothingIsThatOfTheWorst) {
  Parameters p;
  const Eigen::MatrixXd M = Eigen::Vector2d(1e-4, 4e-4).asDiagonal();
  const Eigen::MatrixXd K = Eigen::Vector2d(30, 3).asDiagonal();
  const double both =
      eta_min_compliant(M, Eigen::Vector2d(0.012, 0.012), p, K, Eigen::Matrix2d::Zero());
  const double light = eta_min_compliant(scalar(1e-4), damping(0.012), p, scalar(30), scalar(0));
  const double heavy = eta_min_compliant(scalar(4e-4), damping(0.012), p, scalar(3), scalar(0));
  EXPECT_NEAR(both, std::max(light, heavy), 2e-6);
}

TEST(GripLimit, CountsTheGripsDampingAsRouthDoes) {
  Parameters p;
  p.k_vc = 1e4;
  for (const double damping_of_grip : {1e-4, 3e-4}) {
    const double locked =
        eta_min_grip(LockedMode{2e-4, 0.012 + p.b_v, p.alpha}, 20, damping_of_grip);
    ASSERT_GT(locked, 0.1);
    EXPECT_NEAR(
        eta_min_compliant(scalar(2e-4), damping(0.012), p, scalar(20), scalar(damping_of_grip)),
        locked, 1e-3);
  }
}

// Held by 10,000 N/m without damping the coupling's spring hides the proxy's damper: eta 0.6 swings
// up, as a run shows.
TEST(GripLimit, IsAboveRouthsInAStiffGrip) {
  const ArmDescription arm = test::omni();
  Parameters p;
  p.hand_damping = 0;
  const auto limit = [&](double stiffness) {
    p.hand_stiffness = stiffness;
    return analyze(arm, rest_pose(arm), p, std::nullopt).eta_min_compliant;
  };
  EXPECT_GT(limit(10'000), 0.65);
  p.kind = CouplingKind::proposed;
  p.eta = 0.6;
  EXPECT_EQ(passivity(analyze(arm, rest_pose(arm), p, std::nullopt), p).passive, false);
  EXPECT_LT(limit(300), limit(10'000));
}

}  // namespace
}  // namespace limpid
