#include "app/experiments/felt_impedance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/experiments/observer.h"
#include "core/coupling/eta_min.h"

namespace limpid {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTick = 0.001;

// Record of a shaken one-joint mass and damper over two periods: mean torque and position in closed
// form.
Session shaken(const Multisine& shaking, double m, double b, double seconds) {
  Session s;
  s.info.tick = kTick;
  s.info.dof = 1;
  s.layout = RowLayout(1);
  const auto stride = static_cast<std::size_t>(s.layout.stride());
  const auto count = static_cast<std::size_t>(std::llround(seconds / kTick)) + 1;
  s.rows.assign(count * stride, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const std::span<double> row = std::span(s.rows).subspan(k * stride, stride);
    const double t = static_cast<double>(k) * kTick;
    const auto speed = [&](double at) {
      double v = 0;
      for (const auto& line : shaking.lines) {
        const double w = 2 * kPi * shaking.frequency(line);
        v += line.amplitude * w * std::cos(w * at + line.phase);
      }
      return v;
    };
    const double x = shaking.at(t);
    // The integral of m x'' + b x' over the tick.
    const double impulse = m * (speed(t + kTick) - speed(t)) + b * (shaking.at(t + kTick) - x);
    s.layout.in(row, Column::device_position)[0] = x;
    s.layout.in(row, Column::hand_torque)[0] = impulse / kTick;
  }
  return s;
}

TEST(FeltImpedance, OfAMassAndADamperIsTheirs) {
  const double m = 3e-4, b = 0.02;
  const Multisine shaking = multisine(0.5, 0.5, 200, 30, 0.02, 5);
  const Session session = shaken(shaking, m, b, 4);
  const Impedance felt = measured_impedance(session, 2000, 0, shaking);
  ASSERT_EQ(felt.f.size(), shaking.lines.size());
  for (std::size_t i = 0; i < felt.f.size(); ++i) {
    const std::complex<double> Z(b, 2 * kPi * felt.f[i] * m);
    EXPECT_LT(std::abs(felt.Z[i] - Z) / std::abs(Z), 1e-7) << felt.f[i] << " Hz";
  }
  EXPECT_NEAR(apparent_inertia(felt, 200), m, 1e-7 * m);
}

TEST(FeltImpedance, OfTheWholeMotionIsByTheInertiaThatIsGiven) {
  const double m = 3e-4, b = 0.02;
  const Multisine shaking = multisine(0.5, 0.5, 200, 30, 0.02, 5);
  const Eigen::MatrixXd twice = Eigen::MatrixXd::Constant(1, 1, 2 * m);
  for (const FeltMotion& felt : measured_motion(shaken(shaking, m, b, 4), 2000, twice, shaking)) {
    EXPECT_NEAR(felt.inertia, 0.5, 1e-5) << felt.f << " Hz";
    EXPECT_NEAR(felt.damping, b, 1e-6);
    EXPECT_NEAR(felt.mass, 2 * m, 1e-12);
  }
}

TEST(ObserverResponse, InFineTicksIsAFirstOrderLag) {
  std::vector<double> f;
  for (double hertz = 1; hertz < 100; hertz *= 1.02) f.push_back(hertz);
  const Response response = sampled_response(f, 200, 1e-6);
  for (std::size_t i = 0; i < f.size(); ++i) {
    const std::complex<double> H = 200.0 / std::complex<double>(200, 2 * kPi * f[i]);
    EXPECT_NEAR(response.gain[i], std::abs(H), 1e-3);
    EXPECT_NEAR(response.phase[i], std::arg(H), 1e-3);
  }
  EXPECT_NEAR(gain_bandwidth(response), 200, 1);
  EXPECT_NEAR(phase_bandwidth(response), 200, 1);
  EXPECT_NEAR(sampled_decay(200, 1e-6), 200, 1e-2);
}

TEST(ObserverResponse, FollowsATickLateHoweverLargeTheGain) {
  const Response response = sampled_response({1, 10, 100}, 1e12, 0.001);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(response.phase[i], -2 * kPi * response.f[i] * 0.001, 1e-6);
  }
}

}  // namespace
}  // namespace limpid
