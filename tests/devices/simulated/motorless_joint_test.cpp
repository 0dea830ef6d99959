// A guarded arm, one joint of which has no motor, pressed onto a table under every law.
#include <gtest/gtest.h>

#include <cmath>

#include "core/tick/safety_limits.h"
#include "devices/simulated/rig.h"
#include "tests/support/built_in.h"
#include "tests/support/guarded_arm.h"
#include "tests/support/rows.h"
#include "tests/support/table.h"
#include "tests/support/wisher.h"

namespace limpid {
namespace {

using test::kTable;

class AJointWithoutAMotor : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Laws, AJointWithoutAMotor, testing::Range(0, static_cast<int>(kLaws)));

TEST_P(AJointWithoutAMotor, GetsNoTorqueAndLeavesTheOthersTheirsAtABoundedRate) {
  ArmDescription arm = test::omni();
  arm.joints[0].effort = 0;
  test::GuardedArm device(arm);
  Rig rig(arm, test::table({600}), &device);
  test::Rows rows(rig.layout());
  test::Wisher wisher;
  Parameters p;
  p.kind = static_cast<CouplingKind>(GetParam());
  rig.start(p, rest_at(arm, kTable + Vec3(0, 0, 0.01)));
  std::array<double, 3> before{};
  double most = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = k * p.tick;
    const Vec3 sways(0, 0.02 * std::sin(6 * t), -0.01 * std::min(1.0, t));
    rig.step(p, {.hand = {kTable + sways, 1}, .force = wisher.at(k > 100)}, rows.add());
    ASSERT_EQ(device.told[0], 0) << k;
    for (std::size_t i = 1; i < 3; ++i) {
      ASSERT_TRUE(std::isfinite(device.told[i])) << k;
      // A torque falls at once.
      const bool turned = device.told[i] * before[i] < 0;
      const double grown = std::abs(device.told[i]) - (turned ? 0 : std::abs(before[i]));
      ASSERT_LE(grown / p.tick, 1.001 * arm.joints[i].effort / SafetyLimits::kSlew) << k;
      most = std::max(most, std::abs(device.told[i]));
    }
    before = device.told;
  }
  // Waves of all joints share their energy, and a joint without a motor takes none back.
  if (p.kind == CouplingKind::wave) return;
  EXPECT_GT(most, 0.05) << "the others push [N m]";
}

}  // namespace
}  // namespace limpid
