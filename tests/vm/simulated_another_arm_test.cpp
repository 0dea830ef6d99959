// A strong device without a description of its arm, pushed against a stiff wall: its motors' torque
// acts at its own tip, whatever the levers of the arm that stands in for it.
#include <gtest/gtest.h>

#include <cstdio>

#include "app/device/taken_arm.h"
#include "tests/support/device_traits.h"
#include "tests/vm/leaned_desk.h"

namespace limpid::test {
namespace {

constexpr double kStrong = 3;       // of its motors [N m]
constexpr double kOwnLever = 0.05;  // of the device; the arm in use has other ones [m]

// The largest torque while a strong hand leans the device through the side of its gate.
double pushed(const ArmDescription& arm) {
  LeanedDesk desk(arm, kStrong);
  desk.push();
  return desk.model->forces().largest();
}

// Holds also with a lower limit set for the tip.
TEST(AnotherArm, IsHeldToTheTipsLimitAtAShortLeverUntilSomebodyHasSaidWhichItIs) {
  const DeviceKind raw{.key = "raw"};
  const DeviceTraits traits = pushing(2, kRange, kStrong);
  for (const double limit : {SafetyLimits{}.tip_force, 4.0}) {
    DeviceNotes notes;
    notes.limits.tip_force = limit;
    const TakenArm taken = taken_arm(notes, &raw, traits);
    ASSERT_FALSE(taken.known);
    const double torque = pushed(taken.arm);
    std::printf("| raw, nobody has said which arm it is | %.3f N m of %.1f | %.1f N at %.2f m |\n",
                torque, kStrong, torque / kOwnLever, kOwnLever);
    EXPECT_GT(torque, 0.1) << "it does push";
    EXPECT_LE(torque / kOwnLever, limit + 0.01) << "to a step of what the report holds";
  }
}

}  // namespace
}  // namespace limpid::test
