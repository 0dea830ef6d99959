// A device with impossible readings for a moment, while its arm follows the hand: torque of the
// motors then and afterwards.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/guarded_arm.h"
#include "tests/support/rows.h"
#include "tests/support/table.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

using test::kTable;

constexpr double kWholeTurn = 2 * std::numbers::pi;
constexpr double kT = 1e-3;

// A device pressed a centimetre into a wall by a hand that holds still.
class LyingDevice : public testing::TestWithParam<CouplingKind> {
 protected:
  LyingDevice() : rig(arm, test::table({600}), &device), rows(rig.layout()) {
    p.kind = GetParam();
    rig.start(p, rest_at(arm, kTable + Vec3(0, 0, 0.01)));
    step(500);
    armed = true;
    step(1500);
    full = torque();
  }
  ForceState step(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      const double t = kT * static_cast<double>(rows.size());
      const Vec3 trembles(0, 2e-4 * std::sin(60 * t), 0);
      const Vec3 target = kTable - std::min(t / 0.4, 1.0) * Vec3(0, 0, 0.01) + trembles;
      rig.step(p, {.hand = {target, 1}, .force = wisher.at(armed)}, rows.add());
    }
    return rig.force_state();
  }
  double torque() const { return Vec3(device.told[0], device.told[1], device.told[2]).norm(); }
  double apart(std::size_t k) const {
    return (rows.vec(k, Column::proxy_position) - rows.vec(k, Column::device_position)).norm();
  }
  const ArmDescription arm = test::omni();
  test::GuardedArm device{arm};
  Parameters p;
  Rig rig;
  test::Rows rows;
  test::Wisher wisher;
  bool armed = false;
  double full = 0;  // torque of a hand that leans on the wall [N m]
};
INSTANTIATE_TEST_SUITE_P(Laws, LyingDevice,
                         testing::Values(CouplingKind::standard, CouplingKind::proposed,
                                         CouplingKind::predictive, CouplingKind::tank),
                         [](const auto& of) { return std::string(name(of.param)); });

TEST_P(LyingDevice, IsWithoutForceAtOnceAndForGoodAfterOneWrongReading) {
  ASSERT_GT(full, 0.1);
  for (const double off : {1e6, -100.0, kWholeTurn, -kWholeTurn, 0.7}) {
    for (std::size_t joint = 0; joint < 3; ++joint) {
      SCOPED_TRACE(testing::Message() << off << " rad, joint " << joint + 1);
      const std::size_t first = rows.size();
      device.off[joint] = off;
      EXPECT_EQ(step(), ForceState::wrong);
      EXPECT_EQ(torque(), 0);
      device.off = {};
      for (int i = 0; i < 300; ++i) {
        ASSERT_EQ(step(), ForceState::wrong);
        ASSERT_EQ(torque(), 0);
      }
      for (std::size_t k = first; k < rows.size(); ++k) {
        ASSERT_LT(apart(k), 0.1) << "the proxy was thrown, " << k - first << " ticks later";
        ASSERT_LT(rows.vec(k, Column::measured_velocity).norm(), 10);
        ASSERT_LT(rows.vec(k, Column::hand_torque_estimate).norm(), 1);
        ASSERT_LT(
            (rows.vec(k, Column::measured_position) - rows.vec(k - 1, Column::measured_position))
                .norm(),
            0.01);
      }
      armed = false;
      step();
      armed = true;
      EXPECT_EQ(step(2000), ForceState::on) << "armed again it is as before";
      EXPECT_NEAR(torque(), full, 0.1 * full);
    }
  }
}

// A jump within a hand's ability is no fault. Force is gone for its speed and comes back by itself,
// with a law that has forgotten the jump.
TEST_P(LyingDevice, PushesNoHarderAfterAJumpThatAHandCouldMake) {
  for (const double off : {0.1, 0.3, 0.5, -0.5}) {
    for (const int ticks : {1, 3}) {
      SCOPED_TRACE(testing::Message() << off << " rad for " << ticks << " ms");
      device.off[0] = off;
      step(ticks);
      EXPECT_EQ(torque(), 0);
      device.off = {};
      for (int k = 0, faded = 0; k < 600; ++k) {
        step();
        if (torque() > 0) ++faded;
        ASSERT_LT(faded > 0 ? apart(rows.size() - 1) : 0, 0.1);
        ASSERT_LT(torque(), 2 * full * faded / 500 + 0.02) << k;
      }
      EXPECT_TRUE(rig.force().armed());
      armed = false;  // an account that counted the jump lets no force through until then
      step();
      armed = true;
      step(2000);
      EXPECT_NEAR(torque(), full, 0.1 * full);
    }
  }
}

TEST_P(LyingDevice, ComesBackWithItsProxyOnTheDevice) {
  for (int k = 0; k < 25; ++k) {
    device.off[0] += 0.03;  // 30 rad/s
    step();
  }
  EXPECT_EQ(torque(), 0);
  EXPECT_GT(apart(rows.size() - 1), 1e-3);
  while (torque() == 0) step();
  // The first torque dates from the tick in which device and proxy coincided, or the next: a spring
  // of zero length pulls on neither.
  const std::size_t k = rows.size() - 1;
  EXPECT_LT(std::min(apart(k), apart(k - 1)), 1e-12);
}

}  // namespace
}  // namespace limpid
