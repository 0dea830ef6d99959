#include "core/math/solve.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

// Runs with every remainder of a loop by fours as the number of joints, and with the two compiled
// sizes.
template <class F>
void for_sizes(const F& f) {
  for (int n = 1; n <= kMaxDof; ++n) f(std::integral_constant<int, kAnyDof>{}, n);
  f(std::integral_constant<int, 3>{}, 3);
  f(std::integral_constant<int, 7>{}, 7);
}

TEST(Solve, FactorsByTheLowerTriangleAlone) {
  Random random(31);
  for_sizes([&](auto N, int n) {
    const Eigen::MatrixXd whole = random.positive_definite(n, 0.1, 10);
    Mat<N> A = whole;
    A.template triangularView<Eigen::StrictlyUpper>().setConstant(1e3);
    const Mat<N> L = cholesky<N>(A);
    const Eigen::MatrixXd lower = Eigen::MatrixXd(L).triangularView<Eigen::Lower>();
    EXPECT_TRUE(Eigen::MatrixXd(L) == lower) << n;
    EXPECT_LT((L * L.transpose() - whole).norm(), 1e-13 * whole.norm()) << n;
    const Vec<N> b = random.vector(n, 1);
    const Vec<N> x = SymmetricFactor<N>(A).solve(b);
    EXPECT_LT((whole * x - b).norm(), 1e-12) << n;
    const Mat<N> X = random.matrix(n, 1);
    Wide<N> over = widened<N>(X);
    SymmetricFactor<N>(A).divide(over);
    EXPECT_LT((narrowed<N>(over) * whole - X).norm(), 1e-12 * X.norm()) << n;
    Vec<N> y = b, z = b;
    solve_lower<N>(L, y.data());
    solve_transposed<N>(L, z.data());
    EXPECT_LT((L * y - b).norm(), 1e-13) << n;
    EXPECT_LT((L.transpose() * z - b).norm(), 1e-12) << n;
  });
}

TEST(Solve, MovesAFactorAsItsMatrixMoves) {
  Random random(32);
  for_sizes([&](auto N, int n) {
    const Mat<N> A = random.positive_definite(n, 0.1, 10), half = random.matrix(n, 1);
    const Mat<N> Adot = half + half.transpose();
    const Mat<N> L = cholesky<N>(A), Ldot = cholesky_rate<N>(L, Adot);
    EXPECT_LT((Ldot * L.transpose() + L * Ldot.transpose() - Adot).norm(), 1e-11 * Adot.norm())
        << n;
    EXPECT_TRUE(Eigen::MatrixXd(Ldot).isLowerTriangular(0)) << n;
    // With Adot = C + C^T the rest of C is skew.
    const Mat<N> skew = skew_rest<N>(half, L, Ldot), wanted = half - L * Ldot.transpose();
    EXPECT_LT((skew - wanted).norm(), 1e-11 * half.norm()) << n;
    EXPECT_EQ((skew + skew.transpose()).norm(), 0) << n;
    MovingFactor<N> factor;
    factor.compute(A);
    factor.follow(half);
    EXPECT_LT((narrowed<N>(factor.S()) - wanted).norm(), 1e-11 * half.norm()) << n;
    const Vec<N> x = random.vector(n, 1);
    EXPECT_LT((factor.times(x) - L * x).norm(), 1e-12) << n;
    EXPECT_LT((factor.turned_times(x) - L.transpose() * x).norm(), 1e-12) << n;
    EXPECT_LT((factor.turned_times(factor.solve_turned(x)) - x).norm(), 1e-12) << n;
  });
}

TEST(Solve, MultipliesWideMatricesAsOthers) {
  Random random(34);
  for_sizes([&](auto N, int n) {
    const Mat<N> A = random.matrix(n, 1), B = random.matrix(n, 1), C = random.matrix(n, 1);
    const Wide<N> a = widened<N>(A), b = widened<N>(B);
    Wide<N> product = widened<N>(C);
    take_product<N>(a, b, product);
    const Wide<N> turned_product = minus_product_turned<N>(a, b);
    EXPECT_LT((narrowed<N>(product) - (C - A * B)).norm(), 1e-13) << n;
    EXPECT_LT((narrowed<N>(turned_product) + A * B.transpose()).norm(), 1e-13) << n;
    EXPECT_EQ((narrowed<N>(turned<N>(a)) - A.transpose()).norm(), 0) << n;
    const Vec<N> x = random.vector(n, 1);
    EXPECT_LT((times<N>(a, x) - A * x).norm(), 1e-13) << n;
    EXPECT_LT((turned_times<N>(a, x) - A.transpose() * x).norm(), 1e-13) << n;
    for (const Wide<N>& wide : {product, turned_product, turned<N>(a)}) {
      EXPECT_EQ(wide.bottomRows(wide.rows() - n).norm(), 0) << n;
    }
  });
}

TEST(Solve, FindsWhatNeedsItsRowsExchanged) {
  Random random(33);
  for_sizes([&](auto N, int n) {
    for (int trial = 0; trial < 20; ++trial) {
      Mat<N> A = random.matrix(n, 1);
      if (n > 1) A.diagonal().setZero();
      if (n > 1 && std::abs(Eigen::MatrixXd(A).determinant()) < 1e-6) continue;
      const Vec<N> b = random.vector(n, 1);
      const Mat<N> B = random.matrix(n, 1);
      const Factor<N> factor(A);
      const Eigen::MatrixXd inverse = Eigen::MatrixXd(A).inverse();
      const double tolerance = 1e-13 * n * inverse.norm() * Eigen::MatrixXd(A).norm();
      EXPECT_LT((factor.solve(b) - inverse * b).norm(), tolerance * inverse.norm()) << n;
      EXPECT_LT((factor.solve(B) - inverse * B).norm(), tolerance * inverse.norm()) << n;
      EXPECT_LT((solve<N>(A, b) - inverse * b).norm(), tolerance * inverse.norm()) << n;
    }
  });
}

}  // namespace
}  // namespace limpid
