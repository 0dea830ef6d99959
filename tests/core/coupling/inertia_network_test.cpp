// The networks' passivity under any motion, and the inertia that they present.
#include "core/coupling/inertia_network.h"

#include <gtest/gtest.h>

#include <complex>

#include "core/math/eigen.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Matrix = Mat<kAnyDof>;
using Vector = Vec<kAnyDof>;
using Complex = std::complex<double>;

constexpr double kBand = 5.3;    // [Hz]
constexpr double kLight = 1e-4;  // M2 / M1 of a proxy that bounds no eta of these tests [-]
constexpr double kA1 = 1.0081, kA2 = 1.4799, kA3 = 0.344, kR = 1.3198, kR1 = 0.05;

// The damping that the ladder needs, by its proof [N m s/rad].
double price(double eta, const Matrix& M_L, double T, double band) {
  const double w2 = 2 * std::numbers::pi * band, k = w2 * w2 / kA1;
  const Matrix N = (1 - eta) / (1 + (kR + kR1) * w2 * T / 2) * M_L;
  const double largest = symmetric_eigen(N).values.maxCoeff();
  return largest * (k * T / 2 + k * k * T * T / (16 * w2 * kR1));
}

// A device of a few joints on the network, moved at will.
class Moved {
 public:
  Moved(int n, unsigned seed) : random(seed) { network.start(n); }

  struct Tick {
    double given;  // work and change of storage [J]
    double paid;   // share that the device's damping must cover [J]
    double size;   // [J]
  };
  Tick tick(double eta, const Matrix& M_L, double gain, const Vector& dx, double T, double band) {
    const double before_set = network.storage();
    network.set({eta, edge}, M_L, gain, T, band);
    const double before = network.storage();
    EXPECT_LE(before, before_set);  // a crossing of 1 loses it
    const Vector torque = network.force() - network.damping() * (dx / T);
    const double cost = eta < 1 ? price(eta, M_L, T, band) : 0;
    network.advance(dx, T);
    const double after = network.storage(), work = torque.dot(dx);
    EXPECT_GE(after, 0);
    return {work + after - before, cost * dx.squaredNorm() / T,
            std::abs(work) + after + before + torque.norm() * dx.norm()};
  }

  Random random;
  double edge = InertiaShape::kFastest;  // of the added inertia [rad/s]
  InertiaNetwork<kAnyDof> network;
};

// Motions of all kinds: noise, oscillation, and long stretches of the same.
class Motions {
 public:
  Motions(Random& random, int n) : random_(random), n_(n), dx_(Vector::Zero(n)) {}
  const Vector& next(double T) {
    const double kind = random_.between(0, 1);
    if (left_-- <= 0) {
      left_ = static_cast<int>(random_.between(1, 100));
      mode_ = random_.between(0, 4);
      speed_ = std::pow(10, random_.between(-3, 1));
      rate_ = 2 * std::numbers::pi * std::pow(10, random_.between(-1, 2.6));
      direction_ = random_.vector(n_, 1);
    }
    time_ += T;
    if (mode_ < 1) {
      dx_ = T * speed_ * random_.vector(n_, 1);
    } else if (mode_ < 2) {
      dx_ = T * speed_ * std::sin(rate_ * time_) * direction_;
    } else if (mode_ < 3) {
      dx_ = T * speed_ * direction_;
    } else {
      dx_ = (kind < 0.1 ? T * speed_ : 0) * direction_;
    }
    return dx_;
  }

 private:
  Random& random_;
  int n_;
  int left_ = 0;
  double mode_ = 0, speed_ = 0, rate_ = 1, time_ = 0;
  Vector dx_, direction_;
};

class InertiaNetworkOfJoints : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Joints, InertiaNetworkOfJoints, testing::Values(1, 3, 7));

TEST_P(InertiaNetworkOfJoints, GivesNoMoreThanItStoredAndItsPriceHowever) {
  const int n = GetParam();
  Moved moved(n, 61);
  Random& random = moved.random;
  Motions motions(random, n);
  double eta = 0.3, T = 0.001;
  Matrix M = random.positive_definite(n, 1e-4, 1e-3);
  int ladder = 0, ghost = 0;
  for (int k = 0; k < 40000; ++k) {
    if (random.between(0, 1) < 0.02) eta = random.between(0, 1) < 0.6 ? 0.05 : random.between(0, 5);
    eta = std::clamp(eta + random.between(-0.02, 0.02), 0.0, 5.0);
    if (random.between(0, 1) < 0.01) eta = 1;
    if (random.between(0, 1) < 0.001) T = random.between(2e-4, 2e-3);
    // The model's inertia may take any value, and jump.
    if (random.between(0, 1) < 0.1) M = random.positive_definite(n, 1e-5, 1e-2);
    const double gain = random.between(0, 1);
    const auto tick = moved.tick(eta, M, gain, motions.next(T), T, kBand);
    ASSERT_LE(tick.given, tick.paid + 1e-13 * tick.size) << k << " eta " << eta;
    ladder += eta < 1 ? 1 : 0;
    ghost += eta > 1 ? 1 : 0;
  }
  EXPECT_GT(ladder, 5000);
  EXPECT_GT(ghost, 5000);
}

TEST_P(InertiaNetworkOfJoints, GivesNothingWhenItsBandChanges) {
  const int n = GetParam();
  Moved moved(n, 62);
  Motions motions(moved.random, n);
  const Matrix M = moved.random.positive_definite(n, 1e-4, 1e-3);
  double band = kBand;
  for (int k = 0; k < 10000; ++k) {
    if (moved.random.between(0, 1) < 0.05) band = moved.random.between(0.5, 20);
    const auto tick = moved.tick(0.3, M, 1, motions.next(0.001), 0.001, band);
    ASSERT_LE(tick.given, tick.paid + 1e-13 * tick.size) << k;
  }
}

TEST_P(InertiaNetworkOfJoints, AtNaturalInertiaIsNotThere) {
  const int n = GetParam();
  Moved moved(n, 63);
  const Matrix M = moved.random.positive_definite(n, 1e-4, 1e-3);
  for (const double eta : {0.3, 1.0, 2.0, 1.0}) {
    for (int k = 0; k < 20; ++k) moved.tick(eta, M, 1, moved.random.vector(n, 1e-3), 0.001, kBand);
    if (eta != 1) {
      EXPECT_GT(moved.network.storage(), 0);
      EXPECT_EQ(moved.network.damps(), eta > 1);
      continue;
    }
    EXPECT_EQ(moved.network.storage(), 0);
    EXPECT_EQ(moved.network.force(), Vector::Zero(n));
    EXPECT_EQ(moved.network.damping(), Matrix::Zero(n, n));
  }
}

// The network's response to a device that swings, with the mean velocity over each tick: force over
// acceleration at the frequency [kg m^2]. Its real part is a mass that pushes along with the
// device.
Complex mass_added(double eta, double M, double hertz, double T) {
  InertiaNetwork<1> network;
  network.start(1);
  const double w = 2 * std::numbers::pi * hertz;
  const int period = static_cast<int>(std::lround(1 / (hertz * T)));
  const int settle = static_cast<int>(2 / T) / period * period + 2 * period;
  Complex torque = 0, acceleration = 0;
  const auto x = [&](double t) { return std::sin(w * t); };
  for (int k = 0; k < settle + 4 * period; ++k) {
    const double t = k * T, dx = x(t + T) - x(t), middle = t + T / 2;
    network.set({eta, InertiaShape::kFastest}, Mat<1>::Constant(M), 1, T, kBand);
    const double f = network.force()[0] - network.damping()(0, 0) * dx / T;
    network.advance(Vec<1>::Constant(dx), T);
    if (k < settle) continue;
    const Complex turn = std::exp(Complex(0, -w * middle));
    torque += f * turn;
    acceleration += -w * w * std::sin(w * middle) * turn;
  }
  return torque / acceleration;
}

TEST(InertiaNetwork, TakesAwayItsShareOfTheInertiaInTheBand) {
  for (const double eta : {0.1, 0.3, 0.6, 0.9}) {
    for (const double hertz : {0.5, 1.0, 2.0, 4.0, 5.0}) {
      const double share = mass_added(eta, 7e-4, hertz, 0.001).real() / 7e-4;
      EXPECT_NEAR(share, 1 - eta, 0.03 * (1 - eta)) << eta << " at " << hertz << " Hz";
    }
    for (const double hertz : {1.0, 2.0, 4.0, 5.0}) {
      const double share = mass_added(eta, 7e-4, hertz, 0.001).real() / 7e-4;
      EXPECT_NEAR(share, 1 - eta, 0.015 * (1 - eta)) << eta << " at " << hertz << " Hz";
    }
  }
}

// Impedance of the ladder as a circuit in continuous time, in velocities (nu), in units of its
// band: a spring, then a mass with a damper, then a spring with a damper behind it.
Complex ladder_impedance(double w) {
  const Complex p(0, w);
  const Complex last = 1.0 / (p * kA3 + 1 / kR);
  const Complex middle = 1.0 / (p * kA2 + kR1 + last);
  return 1.0 / (p * kA1 + middle);
}

TEST(InertiaNetwork, BelowOneIsTheCircuitOfItsLadder) {
  // Sampled ten times as often, the network is the circuit: torque over velocity of M = 1 is
  // -w2 Z(j w/w2), felt as an inertia w2 Z/(j w).
  for (const double hertz : {0.5, 2.0, 5.0, 10.0, 40.0}) {
    const double eta = 0.4, w2 = 2 * std::numbers::pi * kBand, w = 2 * std::numbers::pi * hertz;
    const Complex felt = -w2 * ladder_impedance(w / w2) / Complex(0, w);
    const Complex got = mass_added(eta, 1, hertz, 1e-5) / (1 - eta);
    EXPECT_LT(std::abs(got - felt), 2e-3 * std::abs(felt)) << hertz << ' ' << got << felt;
  }
}

TEST(InertiaNetwork, AboveOneIsAMassOnASpringAndDamper) {
  for (const double eta : {1.5, 2.0, 5.0}) {
    for (const double hertz : {0.5, 2.0, 5.0, 10.0, 25.0}) {
      const double x = hertz / 25;
      const Complex s(0, x);
      const Complex wanted = -(1.0 + 1.4 * s) / (1.0 + 1.4 * s + s * s);
      // The torque of a tick acts at its middle on average: a delay of zero.
      const Complex got = mass_added(eta, 7e-4, hertz, 0.001) / (7e-4 * (eta - 1));
      EXPECT_LT(std::abs(got - wanted), 0.01 + 0.1 * x * x)
          << eta << " at " << hertz << ' ' << got << wanted;
    }
    for (const double hertz : {0.5, 1.0, 2.0, 4.0}) {
      const double share = -mass_added(eta, 7e-4, hertz, 0.001).real() / 7e-4;
      EXPECT_NEAR(share, eta - 1, 0.03 * (eta - 1)) << eta << " at " << hertz << " Hz";
    }
  }
}

// A device M w' = -B_g w, late by t, in a grip k_h without damping. On the axis M w^2 = k_h + w B_g
// sin(w t), 0 = B_g cos(w t): the added mass may damp no more than beta = B_g/M of w_1 - w_h^2/w_1
// at w_1 = pi/(2 t).
TEST(AddedMass, DampsNoMoreThanADelayBears) {
  for (const double T : {0.0005, 0.001, 0.002, 0.004}) {
    for (const double eta : {1.2, 2.0, 5.0, 20.0, 100.0}) {
      for (int most = 0; most <= 20; ++most) {
        const AddedMass added = added_mass(eta, most, T, kLight);
        const double beta = 2 * 0.7 * (added.eta - 1) * added.edge;
        const double w_1 = std::numbers::pi / (2 * T * (most + 0.7));
        EXPECT_LE(beta, w_1) << "eta " << eta << ", " << most << " ticks of " << T;
        EXPECT_GE(added.edge, 2 * std::numbers::pi * 2 * (1 - 1e-12));
        EXPECT_LE(added.edge, 2 * std::numbers::pi * 25);
        EXPECT_LE(added.eta, eta);
        EXPECT_GT(added.eta, 1);
      }
    }
  }
}

TEST(AddedMass, IsAsItIsSetWhereNothingIsLate) {
  for (const double eta : {0.1, 1.0, 2.0, 5.0}) {
    const AddedMass added = added_mass(eta, 0, 0.001, kLight);
    EXPECT_EQ(added.eta, eta);
    EXPECT_EQ(added.edge, InertiaShape::kFastest);
  }
  // Delays of 1, 2 and 3 ms allow 5 to 10, 5 and 3.3 Hz.
  for (const auto& [most, hertz] : {std::pair(1, 10.0), {2, 5.0}, {3, 3.3}}) {
    EXPECT_NEAR(added_mass(5, most, 0.001, kLight).edge / 2 / std::numbers::pi, hertz, 0.1);
  }
  EXPECT_LT(added_mass(5, 5, 0.001, kLight).eta, 5);
}

// To the proxy at most half of the device's inertia is added: (eta - 1) M2 <= 0.5 M1.
TEST(AddedMass, IsBoundedBesideAHeavyProxy) {
  for (const double ratio : {0.1, 0.25, 0.5, 1.0, 20.0}) {
    for (const double eta : {1.01, 2.0, 5.0, 100.0}) {
      const AddedMass added = added_mass(eta, 0, 0.001, ratio);
      EXPECT_LE((added.eta - 1) * ratio, 0.5 + 1e-12) << "eta " << eta << ", M2/M1 " << ratio;
      EXPECT_GT(added.eta, 1);
      if ((eta - 1) * ratio <= 0.5 && eta <= 5) {
        EXPECT_EQ(added.eta, eta);
      }
    }
    EXPECT_EQ(added_mass(0.5, 0, 0.001, ratio).eta, 0.5);
  }
}

}  // namespace
}  // namespace limpid
