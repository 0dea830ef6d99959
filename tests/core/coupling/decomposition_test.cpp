// The passive decomposition against its definition: S^T diag(M1, M2) S block diagonal, and (11)
// multiplied out with S differentiated numerically.
#include "core/coupling/decomposition.h"

#include <gtest/gtest.h>

#include "core/dynamics/arm.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using test::random_arm;

Dynamics<kAnyDof> dynamics(const Arm<kAnyDof>& arm, const Eigen::VectorXd& x,
                           const Eigen::VectorXd& v, double ratio) {
  Arm<kAnyDof>::Frames f;
  Dynamics<kAnyDof> d;
  arm.frames(x, f);
  arm.inertia_coriolis(f, v, d.M, d.C);
  d.M *= ratio;
  d.C *= ratio;
  d.v = v;
  return d;
}

// (8) the other way round: (v1, v2) = S^-1 (v_L, v_E).
Eigen::MatrixXd s_inverse(const Eigen::MatrixXd& phi) {
  const Eigen::Index n = phi.rows();
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd S(2 * n, 2 * n);
  S << I, phi, I, phi - I;
  return S;
}

Eigen::MatrixXd block_diagonal(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(A.rows() + B.rows(), A.rows() + B.rows());
  D.topLeftCorner(A.rows(), A.rows()) = A;
  D.bottomRightCorner(B.rows(), B.rows()) = B;
  return D;
}

class DecompositionOfJoints : public testing::TestWithParam<int> {
 protected:
  int n() const { return GetParam(); }
  // The decomposition with its matrices written out.
  struct Whole : Decomposition<kAnyDof> {
    Whole(const Dynamics<kAnyDof>& device, const Dynamics<kAnyDof>& proxy)
        : Decomposition(device, proxy) {}
    Eigen::MatrixXd phi = Decomposition::phi(), C_LE = Decomposition::C_LE(phi),
                    C_EL = -C_LE.transpose();
  };
  Whole at(double t) const {
    return {dynamics(arm_, x1_ + t * v1_, v1_, 1), dynamics(arm_, x2_ + t * v2_, v2_, kRatio)};
  }

  static constexpr double kRatio = 0.6;
  Arm<kAnyDof> arm_{random_arm(GetParam(), 60)};
  Random random_{61};
  Eigen::VectorXd x1_ = random_.vector(n(), 2), v1_ = random_.vector(n(), 3);
  Eigen::VectorXd x2_ = x1_ + random_.vector(n(), 0.5), v2_ = random_.vector(n(), 3);
  Dynamics<kAnyDof> device_ = dynamics(arm_, x1_, v1_, 1);
  Dynamics<kAnyDof> proxy_ = dynamics(arm_, x2_, v2_, kRatio);
  double size_ = device_.M.norm() * (v1_.norm() + v2_.norm());
};
INSTANTIATE_TEST_SUITE_P(Arms, DecompositionOfJoints, testing::Values(1, 2, 3, 7, 32));

TEST_P(DecompositionOfJoints, SplitsTheVelocities) {
  const Whole d = at(0);
  const Eigen::VectorXd momentum = device_.M * v1_ + proxy_.M * v2_;
  EXPECT_LT((d.v_E - (v1_ - v2_)).norm(), 1e-14);
  EXPECT_LT((d.M_L * d.v_L - momentum).norm(), 1e-13 * size_);
  Eigen::VectorXd locked_and_shape(2 * n()), both(2 * n());
  locked_and_shape << d.v_L, d.v_E;
  both << v1_, v2_;
  EXPECT_LT((s_inverse(d.phi) * locked_and_shape - both).norm(), 1e-12 * both.norm());
}

TEST_P(DecompositionOfJoints, MakesTheInertiaBlockDiagonal) {
  const Whole d = at(0);
  const Eigen::MatrixXd S = s_inverse(d.phi);
  const Eigen::MatrixXd M = S.transpose() * block_diagonal(device_.M, proxy_.M) * S;
  EXPECT_LT((M.topLeftCorner(n(), n()) - d.M_L).norm(), 1e-13 * M.norm());
  EXPECT_LT(M.topRightCorner(n(), n()).norm(), 1e-13 * M.norm());
  EXPECT_LT(M.bottomLeftCorner(n(), n()).norm(), 1e-13 * M.norm());
}

TEST_P(DecompositionOfJoints, HasTheCoriolisBlocksOfElevenMultipliedOut) {
  // S^-T [ diag(M) d/dt(S^-1) + diag(C) S^-1 ], written with this file's S^-1.
  constexpr double h = 1e-4;
  const auto S_at = [&](double s) { return s_inverse(at(s * h).phi); };
  const Eigen::MatrixXd Sdot = (8 * (S_at(1) - S_at(-1)) - (S_at(2) - S_at(-2))) / (12 * h);
  const Eigen::MatrixXd S = S_at(0);
  const Eigen::MatrixXd C = S.transpose() * (block_diagonal(device_.M, proxy_.M) * Sdot +
                                             block_diagonal(device_.C, proxy_.C) * S);
  const Whole d = at(0);
  EXPECT_LT((C.topRightCorner(n(), n()) - d.C_LE).norm(), 1e-8 * size_);
  EXPECT_LT((C.bottomLeftCorner(n(), n()) - d.C_EL).norm(), 1e-8 * size_);
}

TEST_P(DecompositionOfJoints, HasItsTwoCouplingBlocksSkewToEachOther) {
  const Whole d = at(0);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n(), n());
  const Eigen::MatrixXd C_EL = d.phi.transpose() * device_.C + (d.phi.transpose() - I) * proxy_.C;
  EXPECT_LT((d.C_EL + d.C_LE.transpose()).norm(), 1e-15 * size_);
  EXPECT_LT((d.C_EL - C_EL).norm(), 1e-12 * size_);
}

TEST_P(DecompositionOfJoints, MultipliesVectorsAsItsMatricesDo) {
  const Whole d = at(0);
  const Eigen::VectorXd y = random_.vector(n(), 1);
  EXPECT_LT((d.times_phi(y) - d.phi * y).norm(), 1e-12);
  EXPECT_LT((d.times_phi_T(y) - d.phi.transpose() * y).norm(), 1e-12);
  EXPECT_LT((d.shape_torque() - d.C_LE * d.v_E).norm(), 1e-12 * size_);
}

TEST(Decomposition, OfThreeJointsIsTheSameWithFixedAndWithAnySize) {
  const Arm<kAnyDof> arm(random_arm(3, 62));
  Random random(63);
  const auto one = dynamics(arm, random.vector(3, 2), random.vector(3, 3), 1);
  const auto two = dynamics(arm, random.vector(3, 2), random.vector(3, 3), 0.01);
  const Decomposition<kAnyDof> any(one, two);
  const Decomposition<3> fixed({one.M, one.C, one.v}, {two.M, two.C, two.v});
  EXPECT_LT((fixed.phi() - any.phi()).norm(), 1e-13);
  EXPECT_LT((fixed.v_L - any.v_L).norm(), 1e-12);
  EXPECT_LT((fixed.C_LE(fixed.phi()) - any.C_LE(any.phi())).norm(), 1e-13 * one.C.norm());
}

}  // namespace
}  // namespace limpid
