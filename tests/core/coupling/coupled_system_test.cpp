// Factors and coupled systems against Eigen's dense solver.
#include "core/math/coupled_system.h"

#include <gtest/gtest.h>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

template <int N, template <int> class Rest = SteadyFactor>
void expect_the_dense_solution(int n, unsigned seed) {
  Random random(seed);
  for (int round = 0; round < 100; ++round) {
    // A stiff coupling between a heavy and a light side, with the Coriolis part of a proxy's speed.
    const Mat<N> ww = random.positive_definite(n, 0.1, 2) + random.matrix(n, 0.01);
    const Mat<N> wu = random.matrix(n, 0.05), uw = random.matrix(n, 0.05);
    const Mat<N> uu = random.positive_definite(n, 0.05, 1) + random.matrix(n, 0.005);
    Eigen::MatrixXd A(2 * n, 2 * n);
    A << ww, wu, uw, uu;
    Eigen::VectorXd b = random.vector(2 * n, 3);
    const Eigen::VectorXd wanted = least_squares(A, b);
    const CoupledSystem<N, Rest> system(widened<N>(ww), widened<N>(wu), widened<N>(uw),
                                        widened<N>(uu));
    const Motion<N> got = system.solve({b.head(n), b.tail(n)});
    const double scale = 1e-12 * wanted.norm();
    ASSERT_LT((got.w - wanted.head(n)).norm(), scale);
    ASSERT_LT((got.u - wanted.tail(n)).norm(), scale);
  }
}

TEST(CoupledSystem, HasTheSolutionOfTheWhole) {
  expect_the_dense_solution<3>(3, 51);
  expect_the_dense_solution<7>(7, 51);
  expect_the_dense_solution<7, Factor>(7, 51);
  for (const int n : {1, 2, 3, 7, 32}) {
    expect_the_dense_solution<kAnyDof>(n, 52);
    expect_the_dense_solution<kAnyDof, Factor>(n, 52);
  }
}

TEST(CoupledSystem, MotionsAddUp) {
  Random random(53);
  Motion<3> m{random.point(1), random.point(1)};
  const Motion<3> before = m, response{random.point(1), random.point(1)};
  m.add(2.5, response);
  EXPECT_LT((m.w - (before.w + 2.5 * response.w)).norm(), 1e-15);
  EXPECT_LT((m.u - (before.u + 2.5 * response.u)).norm(), 1e-15);
}

template <int N>
void expect_eigens_solution(int n) {
  Random random(54);
  for (int round = 0; round < 100; ++round) {
    const Mat<N> A = random.positive_definite(n, 0.01, 1) + random.matrix(n, 0.005);
    const Vec<N> b = random.vector(n, 1);
    const Mat<N> B = random.matrix(n, 1);
    const Factor<N> factor(A);
    ASSERT_LT((factor.solve(b) - least_squares(A, b)).norm(), 1e-11 * b.norm());
    const Mat<N> solved = factor.solve(B);
    for (int j = 0; j < n; ++j) {
      ASSERT_LT((solved.col(j) - least_squares(A, B.col(j))).norm(), 1e-11 * B.norm());
    }
    ASSERT_LT((A * factor.solve(b) - b).norm(), 1e-13 * b.norm());
    const SteadyFactor<N> steady(widened<N>(A));
    ASSERT_LT((A * steady.solve(b) - b).norm(), 1e-13 * b.norm());
    Wide<N> over = widened<N>(B);
    steady.divide(over);
    ASSERT_LT((narrowed<N>(over) * A - B).norm(), 1e-13 * B.norm());
  }
}

TEST(Factor, SolvesAsEigenDoes) {
  expect_eigens_solution<3>(3);
  expect_eigens_solution<7>(7);
  for (const int n : {1, 2, 3, 7, 32}) expect_eigens_solution<kAnyDof>(n);
}

}  // namespace
}  // namespace limpid
