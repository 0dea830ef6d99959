// The passivity limits against the closed forms of the theory and against the poles.
#include "core/coupling/eta_min.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/eigen.h"
#include "core/tick/tick.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
constexpr double kPi = 3.14159265358979323846;

TEST(EtaMin, IsAlphaOverAlphaPlusBForEveryMass) {
  for (const double m : {1e-5, 3e-4, 0.2, 7.0}) {
    // alpha = 0.035: 0.593 with b = b_d + b_v = 0.024, 0.745 with b_d = 0.012 alone.
    EXPECT_NEAR(eta_min({m, 0.024, 0.035}), 35.0 / 59, 1e-14);
    EXPECT_NEAR(eta_min({m, 0.012, 0.035}), 35.0 / 47, 1e-14);
  }
}

TEST(EtaMin, IsWhereTheLockedSystemStopsBeingPositiveReal) {
  Random random(100);
  for (int round = 0; round < 50; ++round) {
    const LockedMode mode{std::pow(10, random.between(-5, 0)), random.between(0.001, 0.1),
                          random.between(0.001, 0.2)};
    const double limit = eta_min(mode);
    double least_at = std::numeric_limits<double>::infinity(), least_below = least_at;
    for (double decade = -3; decade <= 4; decade += 0.01) {
      const double w = mode.w_f() * std::pow(10, decade);
      const double scale = 1 / (mode.m * w + mode.b);
      least_at = std::min(least_at, locked_response(mode, limit, w).real() / scale);
      least_below = std::min(least_below, locked_response(mode, 0.98 * limit, w).real() / scale);
    }
    EXPECT_GE(least_at, -1e-12);
    EXPECT_LT(least_below, 0);
  }
}

TEST(LockedResponse, IsTheTransferFunction) {
  // (24) at s = jw, real and imaginary part by hand for eta = 1: 1/(m s + b).
  const auto H = locked_response({2, 3, 5}, 1, 4);
  EXPECT_NEAR(H.real(), 3.0 / 73, 1e-15);
  EXPECT_NEAR(H.imag(), -8.0 / 73, 1e-15);
  // At rest the observer estimates all of the force: 1/(eta b). Far above its band it estimates
  // nothing: 1/(j w m).
  EXPECT_NEAR(locked_response({2, 3, 5}, 0.5, 0).real(), 1 / (0.5 * 3), 1e-15);
  EXPECT_NEAR(std::abs(locked_response({2, 3, 5}, 0.5, 1e9)) * 2e9, 1, 1e-8);
}

TEST(EtaMinBand, IsZeroForFiveHertzWithThePapersBandwidths) {
  // w_c = 50, w_f = 200 rad/s
  EXPECT_EQ(eta_min_band({1, 50, 200}, 2 * kPi * 5), 0);
}

TEST(EtaMinBand, TendsToEtaMinForAnEndlessBand) {
  const LockedMode mode{3e-4, 0.024, 0.035};
  EXPECT_NEAR(eta_min_band(mode, 1e9), eta_min(mode), 1e-9);
  EXPECT_LT(eta_min_band(mode, 500), eta_min(mode));
}

TEST(EtaMinBand, IsWhereThePowerTurnsNegativeAtTheBandsEdge) {
  const LockedMode mode{3e-4, 0.024, 0.035};  // w_f = 117, w_c = 80 rad/s
  for (const double w_b : {120.0, 200.0, 1000.0}) {
    const double limit = eta_min_band(mode, w_b);
    ASSERT_GT(limit, 0);
    for (double w = 0; w <= w_b; w += w_b / 200) {
      EXPECT_GE(locked_response(mode, limit, w).real() * mode.b, -1e-12);
    }
    EXPECT_LT(locked_response(mode, 0.99 * limit, w_b).real(), 0);
  }
}

// Largest real part of the roots of (m s^2 + b s)(s + w_f) + (k + b_h s)(s + w_f/eta).
double slowest(const LockedMode& mode, double eta, double k, double b_h) {
  const double w_f = mode.w_f();
  Eigen::Matrix3d companion;
  companion << -(mode.m * w_f + mode.b + b_h) / mode.m,
      -(mode.b * w_f + k + b_h * w_f / eta) / mode.m, -k * w_f / eta / mode.m, 1, 0, 0, 0, 1, 0;
  return eigenvalues(companion).real().maxCoeff();
}

TEST(EtaMinGrip, IsWhereTheClosedLoopBecomesUnstable) {
  Random random(101);
  int limited = 0;
  for (int round = 0; round < 200; ++round) {
    const LockedMode mode{random.between(1e-4, 1e-3), random.between(0.005, 0.05),
                          random.between(0.01, 0.1)};
    const double k = random.between(1, 100), b_h = random.between(0, 0.02);
    const double limit = eta_min_grip(mode, k, b_h);
    if (limit == 0) {
      EXPECT_LT(slowest(mode, 1e-3, k, b_h), 1e-9);
      continue;
    }
    ++limited;
    EXPECT_LT(slowest(mode, 1.001 * limit, k, b_h), 0);
    EXPECT_GT(slowest(mode, 0.999 * limit, k, b_h), 0);
  }
  EXPECT_GT(limited, 50);
}

TEST(EtaMinGrip, WithoutGripDampingIsEtaMinTimesASoftnessFactor) {
  const LockedMode mode{3e-4, 0.024, 0.035};
  for (const double k : {0.5, 5.0, 50.0}) {
    const double factor = k / (k + mode.b * mode.w_f());
    EXPECT_NEAR(eta_min_grip(mode, k, 0), eta_min(mode) * factor, 1e-14);
  }
  EXPECT_NEAR(eta_min_grip(mode, 1e9, 0), eta_min(mode), 1e-8);
}

TEST(EtaMinGrip, OfTheRigidGripOfTheTheoryIsAbout056) {
  // 3000 N/m at a lever of 0.12 to 0.19 m is 43 to 108 N m/rad in joint space.
  const LockedMode mode{3e-4, 0.024, 0.035};
  for (const double lever : {0.12, 0.15, 0.19}) {
    EXPECT_NEAR(eta_min_grip(mode, 3000 * lever * lever, 0), 0.56, 0.02);
  }
}

TEST(GripPoles, OfOneModeAreTheRootsOfItsPolynomial) {
  const LockedMode mode{3e-4, 0.024, 0.035};
  for (const double eta : {0.3, 0.8, 2.0}) {
    const auto poles = grip_poles(
        Eigen::MatrixXd::Constant(1, 1, mode.m), Eigen::VectorXd::Constant(1, mode.b), mode.alpha,
        eta, Eigen::MatrixXd::Constant(1, 1, 12), Eigen::MatrixXd::Constant(1, 1, 0.01));
    ASSERT_EQ(poles.size(), 3);
    for (const std::complex<double> s : poles) {
      const auto a = (mode.m * s * s + mode.b * s) * (s + mode.w_f());
      const auto b = (12.0 + 0.01 * s) * (s + mode.w_f() / eta);
      EXPECT_LT(std::abs(a + b), 1e-10 * (std::abs(a) + std::abs(b)));
    }
  }
}

TEST(EtaMinGrip, OfDiagonalMatricesIsTheWorstOfTheirModes) {
  Random random(102);
  for (int round = 0; round < 20; ++round) {
    constexpr int n = 3;
    Eigen::VectorXd m(n), b(n), k(n), b_h(n);
    double worst = 0;
    for (int i = 0; i < n; ++i) {
      m[i] = random.between(1e-4, 1e-3);
      b[i] = random.between(0.01, 0.04);
      k[i] = random.between(5, 80);
      b_h[i] = random.between(0, 0.005);
      worst = std::max(worst, eta_min_grip({m[i], b[i], 0.035}, k[i], b_h[i]));
    }
    const double limit =
        eta_min_grip(m.asDiagonal().toDenseMatrix(), b, 0.035, k.asDiagonal().toDenseMatrix(),
                     b_h.asDiagonal().toDenseMatrix());
    EXPECT_NEAR(limit, worst, 2e-6);
  }
}

TEST(EtaMinGrip, OfMatricesIsWhereTheFirstPoleCrosses) {
  Random random(103);
  const Eigen::MatrixXd M = random.positive_definite(3, 1e-4, 1e-3);
  const Eigen::MatrixXd K = random.positive_definite(3, 5, 80);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Zero(3, 3);
  const Eigen::VectorXd b = Eigen::VectorXd::Constant(3, 0.024);
  const double limit = eta_min_grip(M, b, 0.035, K, B);
  const auto fastest_growth = [&](double eta) {
    return grip_poles(M, b, 0.035, eta, K, B).real().maxCoeff();
  };
  EXPECT_LT(fastest_growth(1.01 * limit), 0);
  EXPECT_GT(fastest_growth(0.99 * limit), 0);
  // The grip is passive and M_L enters (23) alone: never above the limit of positive realness.
  EXPECT_LT(limit, 35.0 / 59);
}

TEST(EtaMinGrip, OfAPullInOneDirectionOnlyForgetsTheFreeOnes) {
  // A hand at the tip holds three directions of seven joints.
  Random random(104);
  const Eigen::MatrixXd M = random.positive_definite(7, 1e-4, 1e-3);
  const Eigen::MatrixXd J = random.matrix(7, 0.2).topRows(3);
  const Eigen::MatrixXd K = 3000 * J.transpose() * J, B = 0.0 * K;
  const Eigen::VectorXd b = Eigen::VectorXd::Constant(7, 0.024);
  const double limit = eta_min_grip(M, b, 0.035, K, B);
  EXPECT_GT(limit, 0.2);
  EXPECT_LT(limit, 35.0 / 59);
}

TEST(LockedModes, AreTheEigenvaluesOfTheInertiaLightestFirst) {
  Random random(105);
  const Eigen::MatrixXd M = random.positive_definite(5, 1e-4, 1e-3);
  const auto modes = locked_modes(M, Eigen::VectorXd::Constant(5, 0.02), 0.035);
  ASSERT_EQ(modes.size(), 5u);
  double product = 1;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(modes[i].b, 0.02, 1e-15);
    EXPECT_EQ(modes[i].alpha, 0.035);
    EXPECT_GE(modes[i].m, modes[i > 0 ? i - 1 : 0].m);
    product *= modes[i].m;
    EXPECT_NEAR((M - modes[i].m * Eigen::MatrixXd::Identity(5, 5)).determinant() / M.determinant(),
                0, 1e-9);
  }
  EXPECT_NEAR(product, M.determinant(), 1e-12 * product);
}

TEST(EnergyBooks, AddUpTheWorkOfBothTorques) {
  Random random(106);
  EnergyBooks<kAnyDof> books;
  double commanded = 0, damped = 0;
  constexpr double T = 0.002;
  for (int k = 0; k < 50; ++k) {
    const Vec<kAnyDof> tau1 = random.vector(3, 1), tau2 = random.vector(3, 1);
    const Vec<kAnyDof> dx1 = random.vector(3, 0.01), dx2 = random.vector(3, 0.01);
    const Vec<kAnyDof> b_d = Vec<kAnyDof>::Constant(3, 0.1);
    books.add(tau1, dx1, tau2, dx2, b_d, T);
    for (int i = 0; i < 3; ++i) {
      commanded += tau1[i] * dx1[i] + tau2[i] * dx2[i];
      damped += 0.1 * (dx1[i] / T) * dx1[i];
    }
  }
  EXPECT_NEAR(books.commanded, commanded, 1e-12);
  EXPECT_NEAR(books.total, commanded - damped, 1e-12);
}

TEST(LockedModes, AreDampedByTheirShareOfEachJointsDamping) {
  // u' D u of M's unit eigenvectors: with M diagonal, the joints' own, sorted by mass.
  const Eigen::Vector3d m(5e-4, 1e-4, 3e-4), b(0.05, 0.01, 0.02);
  const auto sorted = locked_modes(m.asDiagonal().toDenseMatrix(), b, 0.035);
  const double masses[] = {1e-4, 3e-4, 5e-4}, dampings[] = {0.01, 0.02, 0.05};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(sorted[i].m, masses[i], 1e-18);
    EXPECT_NEAR(sorted[i].b, dampings[i], 1e-16);
  }
  Random random(107);
  const Eigen::MatrixXd M = random.positive_definite(4, 1e-4, 1e-3);
  const Eigen::VectorXd unequal = Eigen::Vector4d(0.01, 0.03, 0.02, 0.05);
  double total = 0;  // the trace does not depend on the basis
  for (const LockedMode& mode : locked_modes(M, unequal, 0.035)) {
    EXPECT_GE(mode.b, 0.01);
    EXPECT_LE(mode.b, 0.05);
    total += mode.b;
  }
  EXPECT_NEAR(total, 0.11, 1e-15);
}

TEST(GripPoles, SolveTheirEigenvalueProblemWithMatricesThatShareNoModes) {
  // (M s^2 + D s) x + (1/eta - 1) s-filtered grip force and the grip itself, A of f_hat:
  // M s^2 x = -D s x + f + (1-eta)/eta f_hat, f_hat (s + alpha M^-1) = alpha M^-1 f, f = -(K + B s)
  // x.
  Random random(108);
  constexpr int n = 3;
  const Eigen::MatrixXd M = random.positive_definite(n, 1e-4, 1e-3);
  const Eigen::MatrixXd K = random.positive_definite(n, 5, 80);
  const Eigen::MatrixXd B = random.positive_definite(n, 0.001, 0.02);
  const Eigen::VectorXd b = Eigen::Vector3d(0.01, 0.03, 0.05);
  const double alpha = 0.035, eta = 0.7;
  const Eigen::VectorXcd poles = grip_poles(M, b, alpha, eta, K, B);
  ASSERT_EQ(poles.size(), 9);
  using Complex = Eigen::Matrix3cd;
  const Complex I = Complex::Identity();
  const Complex L = (alpha * Eigen::Matrix3d(M).inverse()).cast<std::complex<double>>();
  for (const std::complex<double> s : poles) {
    const Complex f = -(K.cast<std::complex<double>>() + s * B);
    const Complex f_hat = (s * I + L).inverse() * L * f;
    const Complex D = b.asDiagonal().toDenseMatrix().cast<std::complex<double>>();
    const Complex Z = s * s * M + s * D - f - (1 - eta) / eta * f_hat;
    // The smallest singular value is at most this.
    const double smallest = std::sqrt(n) / Z.inverse().norm();
    EXPECT_LT(smallest, 1e-9 * (std::norm(s) * M.norm() + K.norm()));
  }
}

TEST(EnergyBooks, TakeEachJointsOwnDamping) {
  EnergyBooks<3> books;
  const Eigen::Vector3d tau1(0.3, -0.5, 0.7), dx1(0.01, 0.02, -0.03), b_d(0.1, 0.2, 0.4);
  const Eigen::Vector3d tau2(-0.2, 0.1, 0.6), dx2(0.02, -0.01, 0.05);
  books.add(tau1, dx1, tau2, dx2, b_d, 0.5);
  const double work = (0.003 - 0.010 - 0.021) + (-0.004 - 0.001 + 0.030);
  EXPECT_NEAR(books.commanded, work, 1e-16);
  EXPECT_NEAR(books.total, work - 2 * (0.1 * 1e-4 + 0.2 * 4e-4 + 0.4 * 9e-4), 1e-16);
}

TEST(EnergyBooks, FindThatASpringGaveBackWhatItStored) {
  // f = -K d along d: pressed from 0.02 to 0.05 and let go to 0.01, midpoint forces.
  EnergyBooks<1> books;
  const auto one = [](double x) { return Vec<1>::Constant(x); };
  const double K = 30;
  const double depths[] = {0.02, 0.05, 0.03, 0.01};
  const auto stored = [&](double d) { return K * d * d / 2; };
  for (int i = 0; i < 3; ++i) {
    const double middle = (depths[i] + depths[i + 1]) / 2;
    books.add_contact(one(-K * middle), one(depths[i + 1] - depths[i]));
    EXPECT_NEAR(books.contact_gain(stored(depths[i + 1]), stored(depths[0]), 0), 0, 1e-16);
  }
  EXPECT_NEAR(books.contact, K * (0.02 * 0.02 - 0.01 * 0.01) / 2, 1e-16);
}

}  // namespace
}  // namespace limpid
