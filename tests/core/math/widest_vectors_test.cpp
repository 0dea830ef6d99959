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

void expect_the_same_of_wide_factors(Eigen::Index n) {
  using namespace wide;
  test::Random random(904);
  const int dof = static_cast<int>(n);
  const Eigen::Index p = whole_fours(dof);
  const Mat<kAnyDof> A = random.positive_definite(dof, 0.1, 10), C = random.matrix(dof, 1);
  Diagonal<kAnyDof, true> over = Diagonal<kAnyDof, true>::Zero(p, 9), over_narrow = over;

  Wide<kAnyDof> L = widened<kAnyDof>(A), L_narrow = L;
  wide::factor(n, L.data(), over.data());
  columns_by_fours(n, FactorSymmetric{n, L_narrow.data(), over_narrow.data()});
  EXPECT_EQ(L, L_narrow) << n;
  EXPECT_EQ(over, over_narrow) << n;

  Wide<kAnyDof> X = widened<kAnyDof>(C), X_narrow = X;
  wide::divide(n, L.data(), over.data(), X.data());
  columns_by_fours(n, Divide<true>{n, straight(L.data(), n), over.data(), X_narrow.data()});
  columns_by_fours_back(n,
                        Divide<false>{n, wide::turned(L.data(), n), over.data(), X_narrow.data()});
  EXPECT_EQ(X, X_narrow) << n;

  Wide<kAnyDof> Ldot = widened<kAnyDof>(C + C.transpose()), Ldot_narrow = Ldot;
  wide::factor_rate(n, L.data(), over.data(), Ldot.data());
  columns_by_fours(n, FactorRate{n, L.data(), over.data(), Ldot_narrow.data()});
  EXPECT_EQ(Ldot, Ldot_narrow) << n;
  Wide<kAnyDof> S = widened<kAnyDof>(C), S_narrow = S;
  wide::skew_rest(n, L.data(), Ldot.data(), S.data());
  columns_by_fours(n, SkewRest{n, L.data(), Ldot.data(), S_narrow.data()});
  EXPECT_EQ(S, S_narrow) << n;

  Wide<kAnyDof> half = widened<kAnyDof>(A + C), half_narrow = half, other(p, n), other_narrow(p, n);
  wide::turn(n, half.data(), other.data());
  turn_in(n, half.data(), other_narrow.data());
  EXPECT_EQ(other, other_narrow) << n;
  wide::factor_halves(n, half.data(), other.data(), over.data());
  columns_by_fours(n, FactorHalves{n, half_narrow.data(), other_narrow.data(), over_narrow.data()});
  EXPECT_EQ(half, half_narrow) << n;
  EXPECT_EQ(other, other_narrow) << n;
  EXPECT_EQ(over, over_narrow) << n;

  WideVec<kAnyDof> x = widened_vector<kAnyDof>(random.vector(dof, 1)), x_narrow = x;
  wide::solve_halves(n, half.data(), other.data(), over.data(), x.data());
  columns_by_fours(n, SolveLower{n, half.data(), over.data() + p, x_narrow.data()});
  columns_by_fours_back(n, SolveTransposed{n, other.data(), over.data() + 5 * p, x_narrow.data()});
  EXPECT_EQ(x, x_narrow) << n;
}

void expect_the_same_of_wide_products(Eigen::Index n) {
  using namespace wide;
  test::Random random(905);
  const int dof = static_cast<int>(n);
  const Wide<kAnyDof> A = widened<kAnyDof>(random.matrix(dof, 1)),
                      B = widened<kAnyDof>(random.matrix(dof, 1));
  const WideVec<kAnyDof> x = widened_vector<kAnyDof>(random.vector(dof, 1));
  WideVec<kAnyDof> y = WideVec<kAnyDof>::Zero(A.rows()), y_narrow = y;
  wide::take_times(n, A.data(), x.data(), y.data());
  columns_by_fours(n, TakeTimes{n, A.data(), x.data(), y_narrow.data()});
  EXPECT_EQ(y, y_narrow) << n;
  wide::take_turned_times(n, A.data(), x.data(), y.data());
  columns_by_fours(n, TakeTransposedTimes{n, A.data(), x.data(), y_narrow.data()});
  EXPECT_EQ(y, y_narrow) << n;

  Wide<kAnyDof> C = A, C_narrow = A;
  wide::take_product(n, A.data(), B.data(), C.data());
  columns_by_fours(n, TakeProduct<false>{n, A.data(), wide::turned(B.data(), n), C_narrow.data()});
  EXPECT_EQ(C, C_narrow) << n;
  wide::minus_product_turned(n, A.data(), B.data(), C.data());
  columns_by_fours(n, TakeProduct<true>{n, A.data(), straight(B.data(), n), C_narrow.data()});
  EXPECT_EQ(C, C_narrow) << n;
}

TEST(WidestVectors, ReckonEachNumberOfWideMatricesAsNarrowOnesDo) {
  for (Eigen::Index n = 1; n <= kMaxDof; ++n) {
    expect_the_same_of_wide_factors(n);
    expect_the_same_of_wide_products(n);
  }
}

}  // namespace
}  // namespace limpid
