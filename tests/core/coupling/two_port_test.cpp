// Llewellyn's criterion on the couplings, against closed forms, condition (3), and contacts that
// try to break it.
#include "core/coupling/two_port.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

// A hand meets Z11 - Z12 Z21/(Z22 + j X) on a contact that only stores energy. It takes energy for
// all X if and only if the parameter is at least 1.
TEST(Llewellyn, TellsWhetherAnyContactTurnsIntoASource) {
  Random random(1);
  int stable = 0;
  for (int round = 0; round < 300; ++round) {
    const TwoPort p{{random.between(0.1, 2), random.between(-2, 2)},
                    {random.between(0.1, 2), random.between(-2, 2)},
                    {random.between(-2, 2), random.between(-2, 2)}};
    const double value = llewellyn(p);
    if (std::abs(value - 1) < 0.01) continue;
    double least = 1e9;
    for (int i = 1; i < 20'000; ++i) {
      const double X = std::tan(std::numbers::pi * (i / 20'000.0 - 0.5));
      least = std::min(least, (p.one - p.across / (p.two + std::complex<double>(0, X))).real());
    }
    EXPECT_EQ(value > 1, least > 0) << round;
    stable += value > 1 ? 1 : 0;
  }
  EXPECT_GT(stable, 30);
  EXPECT_LT(stable, 270);
}

TEST(Llewellyn, FailsWhereAPortGivesEnergyByItself) {
  EXPECT_LT(llewellyn(TwoPort{-0.1, 1, 0.01}), 1);
  EXPECT_LT(llewellyn(TwoPort{-0.1, -1, 0.01}), 1);
  EXPECT_LT(llewellyn(TwoPort{-0.1, 1, 0}), 1);
  EXPECT_TRUE(std::isinf(llewellyn(TwoPort{0.1, 1, 0})));
}

// Without b_vc the parameter is 1 + 2 sin^2(pi f T) (c - 1), c = (b_d - k T/2) b_v/(k T/2)^2.
TEST(Llewellyn, OfASpringIsTheClosedForm) {
  const double T = 0.001;
  for (const double b_d : {0.011, 0.02}) {
    for (const double b_v : {0.003, 0.005, 0.012}) {
      const SpringDamper gains{10, 0, b_v};
      const double half = gains.k_vc * T / 2, c = (b_d - half) * b_v / (half * half);
      for (const double f : {0.3, 20.0, 200.0, 450.0}) {
        const double sine = std::sin(std::numbers::pi * f * T);
        EXPECT_NEAR(llewellyn(spring_two_port(gains, {b_d, T}, f)), 1 + 2 * sine * sine * (c - 1),
                    1e-9);
      }
      const Llewellyn all = llewellyn(
          [&](double f) {
            return spring_two_port(gains, {b_d, T}, f);
          },
          T);
      if (c > 1) {
        EXPECT_NEAR(all.least, 1, 1e-6);
        EXPECT_FALSE(all.fails_from);
      } else {
        EXPECT_NEAR(all.least, 2 * c - 1, 1e-9);
        EXPECT_NEAR(all.frequency, 500, 1e-6);
        EXPECT_LT(all.fails_from.value(), 1);
      }
    }
  }
}

// d ticks of the motors and l of the link each way turn both: with u = pi f T the device's damping
// is b_d - k T sin((2 d + 1) u)/(2 sin u), and the cosine is -cos(2 (d + 2 l + 1) u).
TEST(Llewellyn, OfASpringIsTheClosedFormWithDelays) {
  const double T = 0.001, b_d = 0.1;
  const SpringDamper gains{10, 0, 0.03};
  for (const int d : {0, 1, 3}) {
    for (const int l : {0, 1, 7}) {
      for (const double f : {3.0, 90.0, 260.0}) {
        const double u = std::numbers::pi * f * T, sine = std::sin(u), kT = gains.k_vc * T;
        const double damping = b_d - kT * std::sin((2 * d + 1) * u) / (2 * sine);
        EXPECT_NEAR(llewellyn(spring_two_port(gains, {b_d, T, d, l}, f)),
                    2 * damping * gains.b_v * 4 * sine * sine / (kT * kT) +
                        std::cos(2 * (d + 2 * l + 1) * u),
                    1e-9)
            << d << " " << l << " " << f;
      }
    }
  }
}

// Without b_vc the paper's condition is where both ports share the cost evenly: on the edge of
// both.
TEST(Llewellyn, IsMetOnTheEdgeOfConditionThreeAndNotBeyond) {
  const double T = 0.001;
  for (const double k : {1.0, 10.0, 40.0}) {
    SpringDamper gains{k, 0, k * T / 2};
    const SampledJoint joint{k * T, T};
    const auto over = [&] {
      return llewellyn([&](double f) { return spring_two_port(gains, joint, f); }, T);
    };
    EXPECT_NEAR(over().least, 1, 1e-9);
    EXPECT_FALSE(over().fails_from);
    gains.b_v *= 0.999;
    EXPECT_TRUE(over().fails_from);
  }
}

// Condition (3) is sufficient, late motors and links included.
TEST(Llewellyn, HoldsWhereverConditionThreeDoes) {
  Random random(3);
  for (int round = 0; round < 100; ++round) {
    SpringDamper gains{random.log_between(0.5, 50), random.log_between(1e-4, 0.02), 0};
    const int delay = static_cast<int>(random.between(0, 4)), link = delay * 3;
    const double T = random.log_between(2e-4, 2e-3);
    const LinkSettings through{.link_delay = link};
    const Condition3 bare = condition3(gains, T, std::array{0.0}, delay * T, through);
    const double b_d = -bare.device_margin * random.between(1.0001, 2);
    gains.b_v = -bare.proxy_margin * random.between(1.0001, 2);
    ASSERT_TRUE(condition3(gains, T, std::array{b_d}, delay * T, through).holds);
    const SampledJoint joint{b_d, T, delay, link};
    const Llewellyn all = llewellyn([&](double f) { return spring_two_port(gains, joint, f); }, T);
    EXPECT_FALSE(all.fails_from) << round << " " << all.least << " " << all.frequency;
  }
}

// The hybrid parameters b_d, 0 and -1/z^(1 + d): cos((1 + d) w T), which no damping mends.
TEST(Llewellyn, OfWallsOnTheDeviceIsTheCosineOfTheLag) {
  for (const int delay : {0, 2}) {
    for (const double f : {1.0, 77.0, 333.0}) {
      const double angle = 2 * std::numbers::pi * f * 0.001 * (1 + delay);
      EXPECT_NEAR(llewellyn(device_two_port({5, 0.001, delay}, f)), std::cos(angle), 1e-12);
    }
  }
}

}  // namespace
}  // namespace limpid
