// The predictor on devices that it knows exactly, and on others.
#include "core/coupling/predictor.h"

#include <gtest/gtest.h>

#include <deque>
#include <numbers>
#include <vector>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using Matrix = Mat<kAnyDof>;
using Vector = Vec<kAnyDof>;

using test::T;

// A device of constant M, C and damping, moved by the midpoint rule.
struct Device {
  Matrix M, C;
  Vector b, x, v;
  Vector w{};  // mean velocity of the last tick

  Device(int n, Random& random)
      : M(random.positive_definite(n, 2e-4, 1e-3)),
        C(random.matrix(n, 2e-4)),
        b(random.vector(n, 0.02).cwiseAbs()),
        x(random.vector(n, 1)),
        v(random.vector(n, 1)) {}
  void step(const Vector& torque) {
    Matrix D = 2 / T * M + C;
    D.diagonal() += b;
    w = least_squares(D, 2 / T * (M * v) + torque);
    x += T * w;
    v = 2 * w - v;
  }
};

class PredictorOfJoints : public testing::TestWithParam<int> {
 protected:
  int n() const { return GetParam(); }
  Vector none() const { return Vector::Zero(n()); }
  Random random_{31};
  Device device_{n(), random_};
  Jacobian<kAnyDof> J_ = 0.1 * random_.matrix(std::max(n(), 3), 1).topLeftCorner(3, n());
  Predictor<kAnyDof> predictor_;

  // Advances device and predictor by a tick with a known torque and an unknown one of a hand.
  void tick(const Vector& tau, const Vector& hand, const PredictorGains& g) {
    predictor_.correct(device_.x, T, 0, g.p, false);
    predictor_.model(device_.M, device_.C, device_.b, J_, T, g.p, g.mu, 0, 0, false);
    predictor_.applied(tau, false);
    device_.step(tau + hand);
  }
};
INSTANTIATE_TEST_SUITE_P(Joints, PredictorOfJoints, testing::Values(1, 3, 7));

TEST_P(PredictorOfJoints, FindsAnUnknownConstantTorqueAndIsExactThen) {
  const Vector hand = random_.vector(n(), 0.3);
  predictor_.start(device_.x, none(), none());
  for (int k = 0; k < 200; ++k) {
    tick(random_.vector(n(), 0.2), hand, {0, 1, 0.2});
    if (k < 30) continue;
    ASSERT_LT((predictor_.w() - device_.w).norm(), 1e-9) << k;
    // The drive is the device's, apart from the known torque.
    const Vector rest = predictor_.D0() * predictor_.w() - predictor_.drive();
    ASSERT_LT((predictor_.D0() * device_.w - predictor_.drive() - rest).norm(), 1e-9);
  }
}

TEST_P(PredictorOfJoints, IsExactWithMemoryAsWellALittleLater) {
  const Vector hand = random_.vector(n(), 0.3);
  predictor_.start(device_.x, none(), none());
  for (int k = 0; k < 200; ++k) {
    tick(random_.vector(n(), 0.2), hand, {0.45, 1, 0.2});
    if (k < 100) continue;
    ASSERT_LT((predictor_.w() - device_.w).norm(), 1e-9) << k;
  }
}

TEST_P(PredictorOfJoints, CorrectsNothingInsideOfAnEncodersCell) {
  constexpr double q = 1e-3, p = 0.3;
  const Vector x = device_.x, v = device_.v, f = random_.vector(n(), 0.1);
  for (int round = 0; round < 100; ++round) {
    predictor_.start(x, v, f);  // predicted for the first reading: x, with v
    Vector beyond = none();
    for (double& e : beyond) {
      if (random_.between(0, 1) < 0.5) e = random_.between(-1, 1) * 1e-3;
    }
    Vector y = x + beyond;
    for (int i = 0; i < n(); ++i) {
      y[i] += beyond[i] == 0 ? q / 2 * random_.between(-1, 1) : std::copysign(q / 2, beyond[i]);
    }
    predictor_.correct(y, T, q, p, false);
    predictor_.model(device_.M, device_.C, device_.b, J_, T, p, 1, 0, 0, false);
    const Vector w0 = none();  // nothing was predicted for the first tick
    const Vector x_ahead = x + T * w0, v_ahead = 2 * w0 - v;
    const Vector error = y - x_ahead;
    for (int i = 0; i < n(); ++i) {
      const double e = beyond[i];
      ASSERT_NEAR(error[i] - std::clamp(error[i], -q / 2, q / 2), e, 1e-15);
      ASSERT_NEAR(predictor_.x_now()[i], x_ahead[i] + (1 - p * p * p) * e, 1e-14);
      ASSERT_NEAR(predictor_.v_now()[i], v_ahead[i] + 1.5 * (1 - p) * (1 - p) * (1 + p) * e / T,
                  1e-11);
    }
    const Vector found = predictor_.drive() - 2 / T * (device_.M * predictor_.v_now());
    const Vector wanted = f + std::pow((1 - p) / T, 2) * (1 - p) * (device_.M * beyond);
    ASSERT_LT((found - wanted).norm(), 1e-10);
  }
}

TEST_P(PredictorOfJoints, MeetsTheDeviceWhereItWillBeAfterAKnownDelay) {
  for (const int delay : {1, 2, 5, 20}) {
    const Vector hand = random_.vector(n(), 0.3);
    predictor_.start(device_.x, none(), none());
    std::deque<Vector> under_way(static_cast<std::size_t>(delay), none());
    std::deque<Vector> foretold;
    for (int k = 0; k < 150; ++k) {
      if (k >= 60) {
        ASSERT_LT((foretold.front() - device_.x).norm(), 1e-9) << delay << ' ' << k;
      }
      if (static_cast<int>(foretold.size()) == delay) foretold.pop_front();
      predictor_.correct(device_.x, T, 0, 0, false);
      predictor_.model(device_.M, device_.C, device_.b, J_, T, 0, 1, 0, delay, false);
      foretold.push_back(predictor_.x());
      const Vector tau = random_.vector(n(), 0.2);
      const Vector acts = under_way.front();
      under_way.pop_front();
      under_way.push_back(tau);
      predictor_.applied(tau, false);
      ASSERT_EQ(predictor_.sent(delay), acts);
      device_.step(acts + hand);
      if (k >= 60) {
        ASSERT_LT((predictor_.w() - device_.w).norm(), 1e-9);
      }
    }
  }
}

TEST_P(PredictorOfJoints, KnowsWhatIsUnderWayWhenTheDelayTurnsOutToBeAnother) {
  predictor_.start(device_.x, none(), none());
  std::vector<Vector> sent(20, none());
  for (const int delay : {0, 3, 1, 20, 0, 5, 2}) {
    for (int k = 0; k < 7; ++k) {
      predictor_.correct(device_.x, T, 0, 0, false);
      predictor_.model(device_.M, device_.C, device_.b, J_, T, 0, 1, 0, delay, false);
      sent.push_back(random_.vector(n(), 0.2));
      const Vector acts = sent[sent.size() - 1 - static_cast<std::size_t>(delay)];
      predictor_.applied(sent.back(), false);
      ASSERT_EQ(predictor_.sent(delay), acts) << delay << ' ' << k;
      device_.step(acts);
    }
  }
}

// Finds the hand's mass with a filter of memory p, or, if that is NaN, through steps q.
class PredictorOfHeavyHands : public PredictorOfJoints {
 protected:
  void find(double p, double q, double exact);
};
INSTANTIATE_TEST_SUITE_P(Joints, PredictorOfHeavyHands, testing::Values(1, 3, 7));

void PredictorOfHeavyHands::find(double p, double q, double exact) {
  constexpr double kMass = 0.2;
  const Matrix light = device_.M, heavy = light + kMass * (J_.transpose() * J_);
  const auto read = [&] {
    return q > 0 ? Vector(q * (device_.x / q).array().round().matrix()) : device_.x;
  };
  predictor_.start(device_.x, device_.v, none());
  int wrong = 0;
  const auto shake = [&](const Matrix& M, bool both) {
    device_.M = M;
    wrong = 0;
    for (int k = 0; k < 400; ++k) {
      const Vector tau = random_.vector(n(), 0.2);
      predictor_.correct(read(), T, q, p, both);
      predictor_.model(light, device_.C, device_.b, J_, T, p, 1, both ? kMass : 0, 0, false);
      const Levers<kAnyDof> on_tip = Matrix(light).inverse() * J_.transpose();
      predictor_.expect_hand(on_tip, J_, both ? kMass : 0, kForceRate);
      predictor_.applied(tau, both);
      device_.step(tau);
      if (k >= 250 && predictor_.heavy_hand() != (both && M(0, 0) == heavy(0, 0))) ++wrong;
    }
  };
  for (int round = 0; round < 3; ++round) {
    shake(heavy, true);
    EXPECT_EQ(wrong, 0) << "with a mass";
    // The active predictor made the prediction, with the hand's mass.
    EXPECT_LT((predictor_.w() - device_.w).norm(), exact);
    shake(light, true);
    EXPECT_EQ(wrong, 0) << "without";
    EXPECT_LT((predictor_.w() - device_.w).norm(), exact);
  }
  shake(heavy, false);
  EXPECT_EQ(wrong, 0) << "without a second predictor";
}

TEST_P(PredictorOfHeavyHands, TakesThemForHeavyAndLetsThemGoAgain) { find(0.2, 0, 1e-9); }

// Velocities through the filter are off by about w^2.5 T^0.5 q/3, w^2 q here at most [rad/s].
TEST_P(PredictorOfHeavyHands, TakesThemForHeavyThroughStepsToo) {
  find(std::numeric_limits<double>::quiet_NaN(), 1e-4, 0.3);
}

// A joint that moves alone: a v' = -b v + f has an exact solution over a tick, even if it dies out.
TEST(Predictor, OfLinksThatDieOutWithinATickIsExact) {
  for (const double a : {1e-6, 0.3, 1.5, 4.0, 20.0}) {  // T b / M
    const double M = 2e-4, b = a * M / T, f = 0.03, v0 = 2, x0 = 0.1;
    const double dies = std::exp(-a), end = v0 * dies - f / b * std::expm1(-a);
    const double mean = f / b - (v0 - f / b) * std::expm1(-a) / a;
    Predictor<kAnyDof> predictor;
    const auto of = [](double value) { return Vec<kAnyDof>::Constant(1, value).eval(); };
    predictor.start(of(x0), of(v0), of(f));
    predictor.begin_at(of(x0));
    const Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Zero(3, 1);
    predictor.model(Mat<kAnyDof>::Constant(1, 1, M), Mat<kAnyDof>::Zero(1, 1), of(b), J, T, 0, 1, 0,
                    0, true);
    predictor.applied(of(0.0), false);
    EXPECT_NEAR(predictor.w()[0], mean, 1e-9 * std::abs(v0)) << a;
    predictor.correct(of(x0 + T * mean), T, 0, 0, false);
    EXPECT_NEAR(predictor.v_now()[0], end, 1e-6 * std::abs(v0)) << a;
  }
}

TEST(TipMoved, IsBoundByTheEasiestDirectionAndTheLongestLever) {
  Random random(51);
  for (int i = 0; i < 200; ++i) {
    const Mat3 A = random.positive_definite(3, 0.01, 50);
    const TipMoved tip = tip_moved(A, A);
    const double largest = symmetric_eigen(A).values[2];
    ASSERT_LE(tip.mass, 1 / largest * (1 + 1e-12));
    ASSERT_GE(tip.mass, 1 / largest / std::pow(3.0, 1.0 / 8));
    ASSERT_GE(tip.lever, std::sqrt(largest) * (1 - 1e-12));
  }
}

// A bar of 0.2 m and 0.002 kg m^2, 50 g at the tip.
TEST(Predictor, JumpsAtAStepByTheFiltersBandwidth) {
  constexpr double q = 4e-4, kLever = 0.2, kInertia = 2e-3, kRate = 10;
  const double w = std::cbrt(std::sqrt(12.0) * kRate * kLever / kInertia / q);
  Jacobian<kAnyDof> J = Jacobian<kAnyDof>::Zero(3, 1);
  J(1, 0) = kLever;
  const auto of = [](double value) { return Vec<kAnyDof>::Constant(1, value).eval(); };
  for (const int delay : {0, 2}) {
    Predictor<kAnyDof> predictor;
    predictor.start(of(0), of(5), of(0));
    predictor.model(Mat<kAnyDof>::Constant(1, 1, kInertia), Mat<kAnyDof>::Zero(1, 1), of(0.01), J,
                    T, 0, 1, 0, delay, false);
    predictor.expect_hand(J.transpose() / kInertia, J, 0, kRate);
    EXPECT_NEAR(predictor.weighed_jump(q), q * w * (1 + w * delay * T), 1e-12) << delay;
    // Fine steps ask for a quicker filter than 1.2/T.
    EXPECT_NEAR(predictor.weighed_jump(1e-7), 1e-7 * 1.2 / T * (1 + 1.2 * delay), 1e-12) << delay;
  }
}

TEST(PredictorSettings, WeighReadingsWithStepsUnlessTheyHaveAMemory) {
  PredictorSettings s;
  EXPECT_FALSE(s.gains(0).weighs());
  EXPECT_EQ(s.gains(0).p, 0.2);
  for (const double q : {1e-6, 1e-4, 1e-3}) {
    EXPECT_TRUE(s.gains(q).weighs());
    EXPECT_EQ(s.gains(q).mu, 1);
    EXPECT_EQ(s.gains(q).damping, 0.2);
  }
  s.inertia = 2;
  EXPECT_EQ(s.gains(1e-3).mu, 2);
}

// Recordings with a memory of their own: above 1.5e-4 rad they have other constants.
TEST(PredictorSettings, KeepTheConstantsOfRecordingsWithAMemory) {
  PredictorSettings s;
  s.memory = 0.3;
  EXPECT_EQ(s.gains(0).p, 0.3);
  EXPECT_EQ(s.gains(1.5e-4).mu, 1);
  EXPECT_EQ(s.gains(1.5e-4).damping, 0.2);
  EXPECT_EQ(s.gains(1.6e-4).p, 0.3);
  EXPECT_EQ(s.gains(1.6e-4).mu, 0.5);
  EXPECT_EQ(s.gains(1.6e-4).damping, 0.1);
}

}  // namespace
}  // namespace limpid
