#include "core/coupling/force_observer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Observer = ForceObserver<kAnyDof>;
using Vector = Vec<kAnyDof>;
using Matrix = Mat<kAnyDof>;

// A device of constant inertia without Coriolis torque, moved exactly by constant torques.
struct Body {
  Matrix M;
  Vector v;
  Vector b_d;

  explicit Body(const Matrix& inertia)
      : M(inertia), v(Vector::Zero(inertia.rows())), b_d(Vector::Zero(inertia.rows())) {}
  void live(double T, const Vector& torque) { v += T * least_squares(M, torque); }
  const Vector& estimate(Observer& observer, double alpha, double T) const {
    return observer.estimate(alpha, T, M, Matrix::Zero(M.rows(), M.rows()), v, b_d);
  }
};

TEST(ForceObserver, FindsAConstantForceWithEveryGainAndTick) {
  // The error's remaining part after a time t is exp(-alpha/m t) in every mode of M.
  for (const int n : {1, 3, 7}) {
    Random random(80);
    const Eigen::MatrixXd M = random.positive_definite(n, 1e-4, 1e-3);
    const SymmetricEigen modes = symmetric_eigen(M);
    const Vector f1 = random.vector(n, 1), tau = random.vector(n, 0.5);
    for (double alpha = 1e-4; alpha <= 1e3; alpha *= 10) {
      for (const double T : {1e-4, 1e-3, 1e-2}) {
        constexpr int kTicks = 5000;
        Observer observer(n);
        Body body(M);
        observer.applied(tau);
        for (int k = 0; k < kTicks; ++k) {
          observer.applied(tau);
          body.live(T, tau + f1);
          body.estimate(observer, alpha, T);
        }
        Eigen::VectorXd left = modes.vectors.transpose() * f1;
        for (int i = 0; i < n; ++i) {
          left[i] *= std::exp(-alpha / modes.values[i] * kTicks * T);
        }
        const Eigen::VectorXd wanted = f1 - modes.vectors * left;
        EXPECT_LT((observer.present() - wanted).norm(), 1e-4 * f1.norm())
            << n << " joints, alpha " << alpha << ", T " << T;
      }
    }
  }
}

TEST(ForceObserver, StaysWithinTheForceItSeesAtAThousandTimesTheExplicitLimit) {
  // alpha T / m = 1000: explicit Euler multiplies its error by 999 a tick.
  constexpr double T = 1e-3, m = 1e-4, alpha = 1000 * m / T;
  Observer observer(1);
  Body body(Matrix::Constant(1, 1, m));
  for (int k = 0; k < 2000; ++k) {
    const Vector f1 = Vector::Constant(1, std::sin(0.03 * k));
    observer.applied(Vector::Zero(1));
    body.live(T, f1);
    // The overshoot is at most |E| < 0.21 of the force's change in a tick.
    ASSERT_LE(std::abs(body.estimate(observer, alpha, T)[0]), 1 + 0.21 * 0.03);
    ASSERT_NEAR(observer.present()[0], f1[0], 2e-3 + 1e-9) << k;
  }
}

TEST(ForceObserver, AnswersAStepAsAFirstOrderFilter) {
  constexpr double m = 2e-4, alpha = 0.035, w_f = alpha / m;
  const auto worst = [&](double T) {
    Observer observer(1);
    Body body(Matrix::Constant(1, 1, m));
    double error = 0;
    for (int k = 1; k * T < 6 / w_f; ++k) {
      observer.applied(Vector::Zero(1));
      body.live(T, Vector::Constant(1, 0.7));
      const double f1_hat = body.estimate(observer, alpha, T)[0];
      error = std::max(error, std::abs(f1_hat - 0.7 * (1 - std::exp(-w_f * T * k))));
    }
    return error / 0.7;
  };
  const double coarse = worst(1e-3), fine = worst(2.5e-4);
  EXPECT_LT(coarse, std::pow(w_f * 1e-3, 2));  // of second order
  EXPECT_LT(fine, coarse / 12);                // nearly a sixteenth
}

TEST(ForceObserver, FollowsTheFilterOfEveryModeOfAMatrix) {
  // In the modes of M the filters are scalar: exp(-alpha/m_i t).
  Random random(81);
  const Eigen::MatrixXd M = random.positive_definite(3, 2e-4, 8e-4);
  const SymmetricEigen modes = symmetric_eigen(M);
  constexpr double alpha = 0.035, T = 1e-5;
  const Eigen::VectorXd f1 = random.vector(3, 1);
  Observer observer(3);
  Body body(M);
  for (int k = 1; k <= 600; ++k) {
    observer.applied(Vector::Zero(3));
    body.live(T, f1);
    body.estimate(observer, alpha, T);
  }
  Eigen::VectorXd share = modes.vectors.transpose() * f1;
  for (int i = 0; i < 3; ++i) share[i] *= 1 - std::exp(-alpha / modes.values[i] * 600 * T);
  EXPECT_LT((observer.present() - modes.vectors * share).norm(), 1e-5);
}

TEST(ForceObserver, TakesTheDevicesOwnDampingForNoHumanForce) {
  // The device coasts under its own damping, stepped by the trapezoidal rule.
  constexpr double m = 3e-4, b_d = 0.012, T = 1e-3;
  Observer observer(1);
  Body body(Matrix::Constant(1, 1, m));
  body.b_d = Vector::Constant(1, b_d);
  body.v = Vector::Constant(1, 2);
  observer.reset(Vector::Zero(1), body.v);
  for (int k = 0; k < 300; ++k) {
    observer.applied(Vector::Zero(1));
    body.v *= (m - b_d * T / 2) / (m + b_d * T / 2);
    ASSERT_NEAR(body.estimate(observer, 0.035, T)[0], 0, 1e-12);
  }
}

TEST(ForceObserver, CountsTheCoriolisTorque) {
  // Constant velocity needs C v: if the motors give just that, nobody else pushes.
  Random random(82);
  const Matrix M = random.positive_definite(3, 1e-4, 1e-3), C = random.matrix(3, 1e-3);
  const Vector v = random.vector(3, 2);
  Observer observer(3);
  observer.reset(Vector::Zero(3), v);
  const Vector Cv = C * v;
  observer.applied(Cv);
  for (int k = 0; k < 1000; ++k) {
    observer.applied(Cv);
    observer.estimate(0.035, 1e-3, M, C, v, Vector::Zero(3));
  }
  EXPECT_LT(observer.present().norm(), 1e-12);
}

TEST(ForceObserver, GoesOnFromTheEstimateItIsGiven) {
  Random random(83);
  const Vector f1 = random.vector(3, 1);
  Observer observer(3);
  observer.reset(f1, Vector::Zero(3));
  EXPECT_EQ(observer.present(), f1);
  // The motors balance the force: nothing moves and nothing changes.
  observer.applied(-f1);
  observer.applied(-f1);
  for (int k = 0; k < 100; ++k) {
    observer.estimate(0.035, 1e-3, random.positive_definite(3, 1e-4, 1e-3), Matrix::Zero(3, 3),
                      Vector::Zero(3), Vector::Zero(3));
  }
  EXPECT_LT((observer.present() - f1).norm(), 1e-12);
}

// A free body whose positions are sampled, and its velocity estimated from them. Between two
// samples of the velocity lie the middles of two ticks.
struct SampledBody {
  explicit SampledBody(Random& random, int n)
      : M(random.positive_definite(n, 1e-4, 1e-3)), x(random.vector(n, 1)), before(x) {
    v = Vector::Zero(n);
  }
  Vector sample(double T) {
    const Vector s = (x - before) / T;
    before = x;
    return s;
  }
  void live(double T, const Vector& torque) {
    const Vector a = least_squares(M, torque);
    x += T * v + 0.5 * T * T * a;
    v += T * a;
  }
  Matrix M;
  Vector x, before, v;
};

TEST(ForceObserver, TakesNoShareOfAMotorThatPushesAtRandomForAHuman) {
  Random random(84);
  constexpr double T = 2e-3;
  constexpr int n = 3;
  SampledBody body(random, n);
  const Matrix nothing = Matrix::Zero(n, n);
  Observer observer(n);
  observer.applied(random.vector(n, 1));  // torque of an earlier run
  observer.applied(random.vector(n, 1));
  observer.estimate(0.1, T, body.M, nothing, random.vector(n, 1), Vector::Zero(n));
  observer.reset(Vector::Zero(n), body.sample(T));
  for (int k = 0; k < 500; ++k) {
    if (k > 0) {
      observer.estimate(0.035, T, body.M, nothing, body.sample(T), Vector::Zero(n));
      ASSERT_LT(observer.present().norm(), 1e-9) << k;
    }
    const Vector tau = random.vector(n, 1);
    observer.applied(tau);
    body.live(T, tau);
  }
}

TEST(ForceObserver, FollowsItsRecurrenceUnderEverythingAtOnce) {
  // d_k = M (v_k - v_k-1)/T + C v_k + b_d (v_k + v_k-1)/2 - (tau_k-1 + tau_k-2)/2 through
  // f_k = f_k-1 + (1 - E)(d_k - f_k-1), E = (1 + (2g - 1) A)(1 + g A)^-2, A = T alpha M^-1,
  // g = 1 - 1/sqrt(2).
  for (const int n : {1, 3, 5}) {
    Random random(85);
    const double T = 3e-3, alpha = 0.21;
    Observer observer(n);
    Vector f = random.vector(n, 1), v = random.vector(n, 2);
    Vector tau = Vector::Zero(n), tau_before = tau;
    observer.applied(random.vector(n, 1));  // torque of an earlier run
    observer.applied(random.vector(n, 1));
    observer.reset(f, v);
    for (int k = 0; k < 100; ++k) {
      const Eigen::MatrixXd M = random.positive_definite(n, 1e-4, 1e-3);
      const Eigen::MatrixXd C = random.matrix(n, 1e-2);
      const Vector next = random.vector(n, 2), b_d = random.vector(n, 0.05);
      const Vector d =
          M * (next - v) / T + C * next - (tau + tau_before) / 2 + b_d.cwiseProduct(next + v) / 2;
      const Eigen::MatrixXd A = T * alpha * M.inverse(), I = Eigen::MatrixXd::Identity(n, n);
      const double g = 1 - std::sqrt(0.5);
      const Eigen::MatrixXd back = (I + g * A).inverse(), E = (I + (2 * g - 1) * A) * back * back;
      f += (I - E) * (d - f);
      v = next;
      ASSERT_LT((observer.estimate(alpha, T, M, C, next, b_d) - f).norm(), 1e-9 * (1 + f.norm()));
      tau_before = tau;
      tau = random.vector(n, 1);
      observer.applied(tau);
    }
  }
}

}  // namespace
}  // namespace limpid
