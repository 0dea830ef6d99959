// Loops of many joints are compiled for SSE2 and AVX2, and chosen when the program is loaded: here
// the chosen ones against the same loops compiled for SSE2 alone. On a processor without AVX2 these
// are the same code.
#include <gtest/gtest.h>

#include <array>

#include "core/math/triangular.h"
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

}  // namespace
}  // namespace limpid
