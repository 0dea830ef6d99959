#include "app/experiments/staggered.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/experiments/moving.h"
#include "core/math/eigen.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

constexpr double T = 1e-3;

// Largest eigenvalue of a tick's map of a mass m on a spring and damper whose other end is fixed.
double largest_eigenvalue(double m, double K, double B) {
  Eigen::Matrix2d step;
  const double v_x = -T * K / m, v_v = 1 - T * B / m;
  step << 1 + T * v_x, T * v_v, v_x, v_v;
  return eigenvalues(step).cwiseAbs().maxCoeff();
}

TEST(StaggeredBody, NeedsTheMassThatJurysCriterionSays) {
  for (const double K : {100.0, 2000.0, 20000.0}) {
    for (const double B : {0.5, 2.0}) {
      const double least = least_staggered_mass(K, B, T);
      EXPECT_LT(largest_eigenvalue(1.001 * least, K, B), 1) << K << " " << B;
      EXPECT_GT(largest_eigenvalue(0.999 * least, K, B), 1) << K << " " << B;
    }
  }
}

HandPath nudge() {
  return hand_path("nudge", T, 0.5, [](double t) { return Vec3(0.2, 0, t > 0.01 ? 1e-4 : 0); });
}

// The hand is so stiff that the device hardly moves.
TEST(StaggeredBody, IsUnstableBelowThatMassOnTheArm) {
  Parameters p;
  p.hand_stiffness = 1e5;
  p.hand_damping = 100;
  p.torque_limit = 100;
  const double least = least_staggered_mass(2000, 2, T);
  for (const double by : {0.8, 1.25}) {
    const StaggeredRun run = run_staggered(test::omni(), p, nudge(),
                                           {.mass = by * least, .stiffness = 2000, .damping = 2});
    EXPECT_EQ(!run.diverged && dies_away(run.speed), by > 1) << by;
  }
}

// A spring without a damper: the body's energy always equals what the tip gave.
TEST(StaggeredBody, HasWhatTheTipGaveIt) {
  const double m = 0.05, g = 9.81;
  Parameters p;
  p.hand_stiffness = 1000;
  const HandPath hand = hand_path("holds", T, 0.3, [](double) { return Vec3(0.18, 0, 0); });
  const StaggeredRun run = run_staggered(test::omni(), p, hand,
                                         {.mass = m,
                                          .stiffness = 1000,
                                          .normal = Vec3(-Vec3::UnitZ()),
                                          .gap = 0.02,
                                          .own = [=](double) { return m * g; }});
  // The body falls freely until it is there.
  const auto k = static_cast<std::size_t>(0.05 / T);
  const double t = static_cast<double>(k + 1) * T;
  EXPECT_NEAR(run.travel[k], -g * t * (t + T) / 2, 1e-12);
  EXPECT_NEAR(run.speed[k], g * t, 1e-12);
  EXPECT_GT(*std::ranges::max_element(run.contact), 1);
  EXPECT_EQ(run.contact.front(), 0);
}

// Record of a point mass that a hand shakes.
TEST(FeltMass, IsThatOfAPointOfMass) {
  const double m = 0.02, f = 3, w = 2 * std::numbers::pi * f;
  TipRecord record{T, {}, {}};
  const Vec3 along = Vec3(1, 2, -1).normalized();
  const auto place = [&](int k) { return Vec3(0.001 * std::sin(w * k * T) * along); };
  for (int k = 0; k <= 2000; ++k) record.tip.push_back(place(k));
  for (int k = 0; k < 2000; ++k) {
    // The mean of -m w^2 x over the tick, beside a damper's force and one across.
    const Vec3 mean = m * w * 0.001 / T * (std::cos(w * (k + 1) * T) - std::cos(w * k * T)) * along;
    const Vec3 v = (place(k + 1) - place(k)) / T;
    record.force.emplace_back(mean + 0.7 * v + Vec3(1, 0, 1) * std::sin(w * k * T));
  }
  EXPECT_NEAR(felt_mass(record, 0, f), m, 1e-9);
  EXPECT_NEAR(felt_mass(record, 1000, f), m, 1e-9);
}

TEST(DiesAway, IsASpeedThatIsLessInTheEnd) {
  std::vector<double> speeds;
  for (int k = 0; k < 100; ++k) speeds.push_back(std::pow(0.99, k) * std::abs(std::sin(k)));
  EXPECT_TRUE(dies_away(speeds));
  std::ranges::reverse(speeds);
  EXPECT_FALSE(dies_away(speeds));
  EXPECT_FALSE(dies_away({}));
}

}  // namespace
}  // namespace limpid
