// The account of one side's tank, tick by tick, against sums by hand.
#include <gtest/gtest.h>

#include "core/coupling/device_tank.h"

namespace limpid {
namespace {

constexpr double kTick = 0.001;

class ADeviceTank : public testing::Test {
 protected:
  ADeviceTank() {
    tank_.expect(0, 0);
    tank_.start(x_, 0.0005);
  }
  // A tick in which the joints turn by `dx` under a torque, with so much damping of the device.
  void tick(const Vec<3>& dx, const Vec<3>& torque, double damping) {
    tank_.sent(torque);
    x_ += dx;
    tank_.settle(x_, Vec<3>::Constant(damping), 0, kTick, kMost);
  }

  static constexpr double kMost = 0.002;  // that the tank keeps [J]
  Vec<3> x_{0.3, -0.2, 0.5};
  DeviceTank<3> tank_;
};

TEST_F(ADeviceTank, PaysForItsTorquesAndTakesInItsDampersWork) {
  const Vec<3> dx(1e-4, -2e-4, 3e-4), torque(0.5, 0.25, 0.4);
  tick(dx, torque, 0.001);
  const double spent = torque.dot(dx), taken = 0.001 * dx.squaredNorm() / kTick;
  EXPECT_NEAR(tank_.energy(), 0.0005 - spent + taken, 1e-15);
}

// Otherwise a hand that shakes the device for a while would fill it for one great blow.
TEST_F(ADeviceTank, KeepsNoMoreThanItMayHoweverMuchIsPutIn) {
  for (int k = 0; k < 50; ++k) tick({0.1, 0.05, -0.1}, Vec<3>::Zero(), 1);
  EXPECT_NEAR(tank_.energy(), kMost, 1e-12);
  tick({0.001, 0, 0}, {0.5, 0, 0}, 0);
  EXPECT_NEAR(tank_.energy(), kMost - 0.0005, 1e-12);
}

TEST_F(ADeviceTank, GetsBackWhatATorqueTakesFromTheHand) {
  tick({0.001, 0, 0}, {0.4, 0, 0}, 0);
  EXPECT_NEAR(tank_.energy(), 0.0001, 1e-15);
  tick({-0.001, 0, 0}, {0.4, 0, 0}, 0);  // the device gives it back
  EXPECT_NEAR(tank_.energy(), 0.0005, 1e-15);
}

}  // namespace
}  // namespace limpid
