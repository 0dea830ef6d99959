// Loops of many joints, compiled for SSE2 and AVX2 and chosen when the program is loaded: the
// chosen ones against the same loops compiled for SSE2 alone. On a processor without AVX2 these are
// the same code.
#include <gtest/gtest.h>

#include <array>

#include "core/math/wide.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using Numbers = Eigen::MatrixXd;

TEST(WidestVectors, ReckonEachNumberAsNarrowOnesDo) {
  test::Random random(903);
  for (Eigen::Index n = 1; n <= kMaxDof; ++n) {
    const int dof = static_cast<int>(n);
    const Numbers A = random.positive_definite(dof, 0.1, 10), C = random.matrix(dof, 1);

    Numbers L = A, L_narrow = A;
    factor_in<kAnyDof>(n, L.data());
    factor_in<kByFours>(n, L_narrow.data());
    EXPECT_EQ(L, L_narrow) << n;

    const Eigen::VectorXd b = random.vector(dof, 1);
    Eigen::VectorXd x = b, x_narrow = b;
    Numbers LU = A + C, LU_narrow = LU;
    std::array<int, kMaxDof> rows{}, rows_narrow{};
    eliminate_in<kAnyDof>(n, LU.data(), rows.data());
    eliminate_in<kByFours>(n, LU_narrow.data(), rows_narrow.data());
    EXPECT_EQ(LU, LU_narrow) << n;
    EXPECT_EQ(rows, rows_narrow) << n;
    solve_eliminated_in<kAnyDof>(n, LU.data(), rows.data(), x.data());
    solve_eliminated_in<kByFours>(n, LU.data(), rows.data(), x_narrow.data());
    EXPECT_EQ(x, x_narrow) << n;
  }
}

// N has code of its own; M gives the same for narrow vectors.
template <int N, int M>
void expect_the_same_of_wide_factors(Eigen::Index n) {
  using namespace wide;
  test::Random random(904);
  const int dof = static_cast<int>(n);
  const Eigen::Index p = whole_fours(dof);
  const Mat<N> A = random.positive_definite(dof, 0.1, 10), C = random.matrix(dof, 1);
  Diagonal<N, true> over = Diagonal<N, true>::Zero(p, 9), over_narrow = over;

  Wide<N> L = widened<N>(A), L_narrow = L;
  wide::factor<N>(n, L.data(), over.data());
  columns_by_fours(n, FactorSymmetric<M>{n, L_narrow.data(), over_narrow.data()});
  EXPECT_EQ(L, L_narrow) << n;
  EXPECT_EQ(over, over_narrow) << n;

  Wide<N> X = widened<N>(C), X_narrow = X;
  wide::divide<N>(n, L.data(), over.data(), X.data());
  columns_by_fours(n, Divide<M, true>{n, straight<M>(L.data(), n), over.data(), X_narrow.data()});
  columns_by_fours_back(
      n, Divide<M, false>{n, wide::turned<M>(L.data(), n), over.data(), X_narrow.data()});
  EXPECT_EQ(X, X_narrow) << n;

  Wide<N> Ldot = widened<N>(C + C.transpose()), Ldot_narrow = Ldot;
  wide::factor_rate<N>(n, L.data(), over.data(), Ldot.data());
  columns_by_fours(n, FactorRate<M>{n, L.data(), over.data(), Ldot_narrow.data()});
  EXPECT_EQ(Ldot, Ldot_narrow) << n;
  Wide<N> S = widened<N>(C), S_narrow = S;
  wide::skew_rest<N>(n, L.data(), Ldot.data(), S.data());
  columns_by_fours(n, SkewRest<M>{n, L.data(), Ldot.data(), S_narrow.data()});
  EXPECT_EQ(S, S_narrow) << n;

  Wide<N> half = widened<N>(A + C), half_narrow = half, other(p, n), other_narrow(p, n);
  wide::turn<N>(n, half.data(), other.data());
  turn_in<M>(n, half.data(), other_narrow.data());
  EXPECT_EQ(other, other_narrow) << n;
  wide::factor_halves<N>(n, half.data(), other.data(), over.data());
  columns_by_fours(n,
                   FactorHalves<M>{n, half_narrow.data(), other_narrow.data(), over_narrow.data()});
  EXPECT_EQ(half, half_narrow) << n;
  EXPECT_EQ(other, other_narrow) << n;
  EXPECT_EQ(over, over_narrow) << n;

  WideVec<N> x = widened_vector<N>(random.vector(dof, 1)), x_narrow = x;
  wide::solve_halves<N>(n, half.data(), other.data(), over.data(), x.data());
  columns_by_fours(n, SolveLower<M>{n, half.data(), over.data() + p, x_narrow.data()});
  columns_by_fours_back(n,
                        SolveTransposed<M>{n, other.data(), over.data() + 5 * p, x_narrow.data()});
  EXPECT_EQ(x, x_narrow) << n;
}

template <int N, int M>
void expect_the_same_of_wide_products(Eigen::Index n) {
  using namespace wide;
  test::Random random(905);
  const int dof = static_cast<int>(n);
  const Wide<N> A = widened<N>(random.matrix(dof, 1)), B = widened<N>(random.matrix(dof, 1));
  const WideVec<N> x = widened_vector<N>(random.vector(dof, 1));
  WideVec<N> y = WideVec<N>::Zero(A.rows()), y_narrow = y;
  wide::take_times<N>(n, A.data(), x.data(), y.data());
  columns_by_fours(n, TakeTimes<M>{n, A.data(), x.data(), y_narrow.data()});
  EXPECT_EQ(y, y_narrow) << n;
  wide::take_turned_times<N>(n, A.data(), x.data(), y.data());
  columns_by_fours(n, TakeTransposedTimes<M>{n, A.data(), x.data(), y_narrow.data()});
  EXPECT_EQ(y, y_narrow) << n;

  Wide<N> C = A, C_narrow = A;
  wide::take_product<N>(n, A.data(), B.data(), C.data());
  columns_by_fours(
      n, TakeProduct<M, false>{n, A.data(), wide::turned<M>(B.data(), n), C_narrow.data()});
  EXPECT_EQ(C, C_narrow) << n;
  wide::minus_product_turned<N>(n, A.data(), B.data(), C.data());
  columns_by_fours(n, TakeProduct<M, true>{n, A.data(), straight<M>(B.data(), n), C_narrow.data()});
  EXPECT_EQ(C, C_narrow) << n;
}

TEST(WidestVectors, ReckonEachNumberOfWideMatricesAsNarrowOnesDo) {
  expect_the_same_of_wide_factors<7, 7>(7);
  expect_the_same_of_wide_products<7, 7>(7);
  for (Eigen::Index n = 1; n <= kMaxDof; ++n) {
    expect_the_same_of_wide_factors<kAnyDof, kByFours>(n);
    expect_the_same_of_wide_products<kAnyDof, kByFours>(n);
  }
}

}  // namespace
}  // namespace limpid
