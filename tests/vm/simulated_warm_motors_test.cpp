// A strong hand that leans a raw device through the side of its gate for half a minute: its motors
// warm up, and the reports have ever less torque.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/tick/motor_warmth.h"
#include "tests/vm/leaned_desk.h"

namespace limpid::test {
namespace {

using namespace std::chrono_literals;

constexpr double kBears = 0.125, kTime = 60;  // [N m, s]

TEST(WarmMotors, OfARawDeviceAreToldWhatTheyBearForHours) {
  ArmDescription arm = read_urdf(assets_dir() / "devices/joystick.urdf");
  for (Joint& joint : arm.joints) {
    joint.continuous = kBears;
    joint.warming = kTime;
  }
  LeanedDesk desk(arm, kEffort);
  ASSERT_TRUE(desk.push());
  desk.run(3000);
  double full = 0;  // time at full torque [s]
  for (std::size_t k = 0; k < desk.row.size(); ++k) {
    full += 1e-3 * (std::abs(desk.row.vec(k, Column::motor_torque)[0]) > 0.99 * kEffort);
  }
  desk.run(10'000);
  const double later = desk.model->forces().largest(desk.now - 1ms);
  desk.run(20'000);
  const double last = desk.model->forces().largest(desk.now - 100ms);
  std::printf(
      "| raw, motors that bear %.3f of %.1f N m for hours | full torque for %.1f s | %.3f N m "
      "10 s later | %.4f N m after 30 s |\n",
      kBears, kEffort, full, later, last);
  // Half as warm as they may be after -t ln(1 - 1/2 (c/p)^2).
  const double half = -kTime * std::log(1 - kWarmFrom * std::pow(kBears / kEffort, 2));
  EXPECT_NEAR(full, half, 0.2);
  EXPECT_LT(later, 1.1 * kBears);
  EXPECT_NEAR(last, kBears, 0.005 * kBears);
  EXPECT_EQ(desk.rig.force_state(), ForceState::on);
}

}  // namespace
}  // namespace limpid::test
