// The impedance of a joint under each law, against the closed forms and the networks in ticks.
#include "core/coupling/felt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/coupling/eta_min.h"
#include "core/coupling/inertia_network.h"

namespace limpid {
namespace {

using std::numbers::pi;

TEST(FeltJoint, IsTheInverseOf24WithoutTicksOrContact) {
  // A stiff coupling and no ticks: (24) itself.
  const FeltJoint joint{2e-4, 0.012, 0.012, 1e9, 0, 0, 0};
  for (const double eta : {0.5, 1.0, 4.0}) {
    for (const double f : {0.5, 7.0, 90.0}) {
      const LockedMode mode{joint.m, 0.024, 0.035};
      const auto Z = 1.0 / locked_response(mode, eta, 2 * pi * f);
      EXPECT_LT(std::abs(joint.proposed(f, eta, mode.w_f()) - Z) / std::abs(Z), 1e-6);
    }
  }
}

TEST(FeltJoint, IsLateByATickAndAHalfOfTheEstimateAndByHalfOneOfTheContact) {
  // Next to no coupling and no proxy's damper: the rest is (m s + b_d) over the observer's share.
  constexpr double T = 0.003, eta = 0.6, w_f = 150;
  const FeltJoint free{2e-4, 0.012, 0, 1e-14, 0, T, 0};
  const FeltJoint wall{2e-4, 0.012, 0, 1e-14, 0, T, 40};
  for (const double f : {2.0, 15.0, 60.0}) {
    const double w = 2 * pi * f;
    const std::complex<double> s(0, w);
    const std::complex<double> share =
        1.0 + (1 - eta) / eta * w_f / (s + w_f) * std::polar(1.0, -1.5 * T * w);
    const std::complex<double> alone = 2e-4 * s + 0.012;
    const std::complex<double> contact = 40.0 / s / eta * std::polar(1.0, -0.5 * T * w);
    EXPECT_LT(std::abs(free.proposed(f, eta, w_f) - alone / share), 1e-9);
    EXPECT_LT(std::abs(wall.proposed(f, eta, w_f) - (alone + contact) / share), 1e-9);
  }
}

TEST(FeltJoint, AtLowFrequencyFeelsTheWallThroughTheProposedAndASeriesSpringThroughTheStandard) {
  const FeltJoint joint{2e-4, 0.012, 0.012, 10, 0.001, 0.001, 20};
  const double f = 1e-4, w = 2 * pi * f;
  EXPECT_NEAR(std::abs(joint.proposed(f, 0.6, 175)) * w, 20, 1e-3);
  EXPECT_NEAR(std::abs(joint.standard(f)) * w, 1 / (1 / 20.0 + 1 / 10.0), 1e-3);
}

TEST(FeltJoint, WithAFastObserverIsTheIdealOne) {
  const FeltJoint joint{2e-4, 0.012, 0.012, 1e9, 0, 0, 0};
  for (const double eta : {0.3, 3.0}) {
    const auto ideal = joint.ideal(20, eta);
    EXPECT_LT(std::abs(joint.proposed(20, eta, 1e9) - ideal) / std::abs(ideal), 1e-6);
  }
}

// Torque over velocity of the network, in ticks of T, under a shaking joint of inertia 1.
std::complex<double> shaken_network(double eta, double band, double f, double T) {
  InertiaNetwork<1> network;
  network.start(1);
  const Mat<1> one = Mat<1>::Identity();
  const double w = 2 * pi * f;
  std::complex<double> torque = 0, velocity = 0;
  const auto ticks = static_cast<int>(std::lround(20 / f / T)), from = ticks / 2;
  for (int k = 0; k < ticks; ++k) {
    network.set({eta, InertiaShape::kFastest}, one, 1, T, band);
    const double t = k * T, middle = t + T / 2;
    const double v = (std::sin(w * (t + T)) - std::sin(w * t)) / (w * T);
    const double u = network.force()[0] - network.damping()(0, 0) * v;
    network.advance(Vec<1>::Constant(v * T), T);
    if (k < from) continue;
    torque -= u * std::polar(1.0, -w * middle);
    velocity += v * std::polar(1.0, -w * middle);
  }
  return torque / velocity;
}

TEST(NetworkImpedance, IsWhatTheNetworksDoInFineTicks) {
  for (const double eta : {0.2, 0.6, 2.0, 5.0}) {
    for (const double f : {0.5, 2.0, 5.0, 20.0}) {
      const std::complex<double> Z =
          network_impedance({eta, InertiaShape::kFastest}, 5.3, 2 * pi * f);
      const std::complex<double> seen = shaken_network(eta, 5.3, f, 1e-5);
      EXPECT_LT(std::abs(seen - Z) / std::abs(Z), 3e-3) << "eta " << eta << ", " << f << " Hz";
    }
  }
}

TEST(NetworkImpedance, ScalesTheInertiaInItsBandAndIsPassive) {
  for (const double eta : {0.1, 0.3, 0.7, 1.0, 3.0}) {
    for (const double f : {0.5, 1.0, 3.0, 5.0}) {
      const double w = 2 * pi * f;
      EXPECT_NEAR(1 + network_impedance({eta, InertiaShape::kFastest}, 5.3, w).imag() / w, eta,
                  0.04 * std::max(1.0, eta));
    }
    for (double f = 0.01; f < 1000; f *= 1.3) {
      EXPECT_GE(network_impedance({eta, InertiaShape::kFastest}, 5.3, 2 * pi * f).real(), -1e-12)
          << eta << " " << f;
    }
  }
}

TEST(FeltJoint, OfThePredictiveLawPaysForLightnessAtLeastWhatEveryPassiveLawHasTo) {
  const FeltJoint joint{2e-4, 0.012, 0.012, 10, 0.001, 0.001, 0};
  for (const double eta : {0.2, 0.5, 0.9}) {
    const double paid = joint.predictive(1e-3, {eta, 0}, 0, 5.3).real();
    EXPECT_GT(paid, joint.least_damping(eta, 5.3));
    EXPECT_LT(paid, 1.4 * joint.least_damping(eta, 5.3));
  }
  EXPECT_EQ(joint.least_damping(2, 5.3), 0);
}

TEST(FeltJoint, OfThePredictiveLawAtItsOwnInertiaIsInertiaDampingAndWall) {
  const FeltJoint joint{2e-4, 0.012, 0.02, 10, 0.001, 0.001, 30};
  const std::complex<double> s(0, 2 * pi * 7);
  const auto Z = joint.predictive(7, {1, 0}, 0.5, 5.3);
  EXPECT_LT(std::abs(Z - (2e-4 * s + 0.016 + 30.0 / s)), 1e-12);
}

}  // namespace
}  // namespace limpid
