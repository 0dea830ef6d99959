// Loops of many joints are compiled for SSE2 and AVX2, and chosen when the program is loaded: here
// the chosen ones against the same loops compiled for SSE2 alone. On a processor without AVX2 these
// are the same code.
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
    const Numbers Adot = C + C.transpose();

    Numbers L = A, L_narrow = A;
    factor_in<kAnyDof>(n, L.data());
    factor_in<kByFours>(n, L_narrow.data());
    EXPECT_EQ(L, L_narrow) << n;

    Numbers Ldot = Adot, Ldot_narrow = Adot;
    rate_in<kAnyDof>(n, L.data(), Ldot.data());
    rate_in<kByFours>(n, L.data(), Ldot_narrow.data());
    EXPECT_EQ(Ldot, Ldot_narrow) << n;

    Numbers S = C, S_narrow = C;
    skew_in<kAnyDof>(n, L.data(), Ldot.data(), S.data());
    skew_in<kByFours>(n, L.data(), Ldot.data(), S_narrow.data());
    EXPECT_EQ(S, S_narrow) << n;

    const Eigen::VectorXd b = random.vector(dof, 1);
    Eigen::VectorXd x = b, x_narrow = b;
    solve_lower_in<kAnyDof>(n, L.data(), x.data());
    solve_lower_in<kByFours>(n, L.data(), x_narrow.data());
    EXPECT_EQ(x, x_narrow) << n;
    solve_transposed_in<kAnyDof>(n, L.data(), x.data());
    solve_transposed_in<kByFours>(n, L.data(), x_narrow.data());
    EXPECT_EQ(x, x_narrow) << n;

    Numbers LU = A + C, LU_narrow = LU;
    std::array<int, kMaxDof> rows{}, rows_narrow{};
    eliminate_in<kAnyDof>(n, LU.data(), rows.data());
    eliminate_in<kByFours>(n, LU_narrow.data(), rows_narrow.data());
    EXPECT_EQ(LU, LU_narrow) << n;
    EXPECT_EQ(rows, rows_narrow) << n;
    x = x_narrow = b;
    solve_eliminated_in<kAnyDof>(n, LU.data(), rows.data(), x.data());
    solve_eliminated_in<kByFours>(n, LU.data(), rows.data(), x_narrow.data());
    EXPECT_EQ(x, x_narrow) << n;
  }
}

// N: with code of its own, and M the same for narrow vectors.
template <int N, int M>
void expect_the_same_of_wide_matrices(Eigen::Index n) {
  using namespace wide;
  test::Random random(904);
  const int dof = static_cast<int>(n);
  const Mat<N> A = random.positive_definite(dof, 0.1, 10), C = random.matrix(dof, 1);
  const Wide<N> wide_A = widened<N>(A), wide_C = widened<N>(C);
  const auto over = [&] { return WideVec<N>::Zero(wide_A.rows()).eval(); };

  Wide<N> L = wide_A, L_narrow = wide_A;
  WideVec<N> scale = over(), scale_narrow = over();
  wide::factor<N>(n, L.data(), scale.data());
  columns_by_fours(n, FactorSymmetric<M>{n, L_narrow.data(), scale_narrow.data()});
  EXPECT_EQ(L, L_narrow) << n;
  EXPECT_EQ(scale, scale_narrow) << n;

  Wide<N> X = wide_C, X_narrow = wide_C;
  wide::divide<N>(n, L.data(), scale.data(), X.data());
  columns_by_fours(n, Divide<M, true>{n, straight<M>(L.data(), n), scale.data(), X_narrow.data()});
  columns_by_fours_back(
      n, Divide<M, false>{n, wide::turned<M>(L.data(), n), scale.data(), X_narrow.data()});
  EXPECT_EQ(X, X_narrow) << n;

  Wide<N> half = widened<N>(A + C), half_narrow = half;
  Wide<N> turned_half(half.rows(), n), turned_half_narrow(half.rows(), n);
  wide::turn<N>(n, half.data(), turned_half.data());
  turn_in<M>(n, half.data(), turned_half_narrow.data());
  EXPECT_EQ(turned_half, turned_half_narrow) << n;
  wide::factor_halves<N>(n, half.data(), turned_half.data(), scale.data());
  columns_by_fours(
      n, FactorHalves<M>{n, half_narrow.data(), turned_half_narrow.data(), scale_narrow.data()});
  EXPECT_EQ(half, half_narrow) << n;
  EXPECT_EQ(turned_half, turned_half_narrow) << n;

  WideVec<N> x = widened_vector<N>(random.vector(dof, 1)), x_narrow = x;
  wide::solve_halves<N>(n, half.data(), turned_half.data(), scale.data(), x.data());
  columns_by_fours(n, SolveLower<M>{n, half.data(), nullptr, x_narrow.data()});
  columns_by_fours_back(n,
                        SolveTransposed<M>{n, turned_half.data(), scale.data(), x_narrow.data()});
  EXPECT_EQ(x, x_narrow) << n;

  WideVec<N> y = over(), y_narrow = over();
  wide::take_times<N>(n, wide_A.data(), x.data(), y.data());
  columns_by_fours(n, TakeTimes<M>{n, wide_A.data(), x.data(), y_narrow.data()});
  wide::take_turned_times<N>(n, wide_C.data(), x.data(), y.data());
  columns_by_fours(n, TakeTransposedTimes<M>{n, wide_C.data(), x.data(), y_narrow.data()});
  EXPECT_EQ(y, y_narrow) << n;

  wide::take_product<N>(n, wide_A.data(), wide_C.data(), X.data());
  columns_by_fours(n, TakeProduct<M, false>{n, wide_A.data(), wide::turned<M>(wide_C.data(), n),
                                            X_narrow.data()});
  EXPECT_EQ(X, X_narrow) << n;
}

TEST(WidestVectors, ReckonEachNumberOfWideMatricesAsNarrowOnesDo) {
  expect_the_same_of_wide_matrices<7, 7>(7);
  for (Eigen::Index n = 1; n <= kMaxDof; ++n) {
    expect_the_same_of_wide_matrices<kAnyDof, kByFours>(n);
  }
}

}  // namespace
}  // namespace limpid
