#include <gtest/gtest.h>

#include "app/run/analysis.h"
#include "core/coupling/eta_min.h"

namespace limpid {
namespace {

Eigen::MatrixXd scalar(double x) { return Eigen::MatrixXd::Constant(1, 1, x); }
Eigen::VectorXd damping(double b) { return Eigen::VectorXd::Constant(1, b); }

TEST(GripLimit, IsRouthsOfTheLockedSystemWhenTheCouplingIsRigid) {
  Parameters p;
  p.k_vc = 1e4;
  for (const double grip : {1.0, 20.0, 500.0}) {
    const double locked = eta_min_grip(LockedMode{2e-4, 0.012 + p.b_v, p.alpha}, grip, 0);
    EXPECT_NEAR(eta_min_compliant(scalar(2e-4), damping(0.012), p, scalar(grip)), locked, 1e-4);
  }
}

TEST(GripLimit, TendsTo25WithTheDevicesDampingAloneInAStiffGrip) {
  Parameters p;
  p.b_vc = 0;
  const double alone = eta_min(LockedMode{2e-4, 0.012, p.alpha});
  EXPECT_NEAR(eta_min_compliant(scalar(2e-4), damping(0.012), p, scalar(1e5)), alone, 2e-3);
}

TEST(GripLimit, OfJointsThatShareNothingIsThatOfTheWorst) {
  Parameters p;
  const Eigen::MatrixXd M = Eigen::Vector2d(1e-4, 4e-4).asDiagonal();
  const Eigen::MatrixXd K = Eigen::Vector2d(30, 3).asDiagonal();
  const double both = eta_min_compliant(M, Eigen::Vector2d(0.012, 0.012), p, K);
  const double light = eta_min_compliant(scalar(1e-4), damping(0.012), p, scalar(30));
  const double heavy = eta_min_compliant(scalar(4e-4), damping(0.012), p, scalar(3));
  EXPECT_NEAR(both, std::max(light, heavy), 2e-6);
}

}  // namespace
}  // namespace limpid
