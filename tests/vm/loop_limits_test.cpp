// Limits that hold on every real device, measured at a device that a stiff hand leads far too fast,
// too far, or along with its motors.
#include <gtest/gtest.h>

#include "tests/vm/desk.h"
#include "tests/vm/models.h"

namespace limpid::test {
namespace {

// A scene that presses the first joint towards smaller angles everywhere, as hard as its motor can.
template <class Model>
struct LimitedLoop : testing::Test {
  // Opens the device; the stick rests at -0.3 rad for 1.2 s, is led to 0.3 at `rate` [rad/s], and
  // stays.
  void open(double rate, double effort = kEffort) {
    AxisPhysics physics = stick_axis(0);
    physics.stiffness = 120 * effort;
    physics.damping = 0.4 * effort;
    physics.inertia *= effort / kEffort;
    physics.path = [rate](double t) { return std::clamp(-0.3 + rate * (t - kStart), -0.3, 0.3); };
    desk = std::make_unique<Desk<Model>>(make_model<Model>(effort));
    desk->device->with([&](Time) { desk->model->hand().axis(0) = physics; });
    desk->arm = arm;
    for (Joint& joint : desk->arm.joints) joint.effort = effort;
    desk->document = {};
    desk->document.scene.add({.shape = JointStop{0, -1, 1}, .material = {100}});
    desk->controls.parameters().k_vc = 100;
    desk->set([&](Controls& controls) { controls.limits = limits; });
    desk->open(Desk<Model>::connect(effort));
    desk->arm_force(true);
    began = desk->device->with([&](Time now) {
      desk->model->hand().begin(now);
      return now + std::chrono::microseconds(static_cast<int>(1e6 * kStart));
    });
  }
  // The smallest |torque| in this time, counted from the start of the hand's motion [N m].
  double least(Time from, Time to) {
    return extreme(
        from, to, [](double a, double b) { return std::min(a, b); }, 1e9);
  }
  double most(Time from, Time to) {
    return extreme(
        from, to, [](double a, double b) { return std::max(a, b); }, 0);
  }
  template <class Choose>
  double extreme(Time from, Time to, Choose choose, double result) {
    return desk->device->with([&](Time) {
      // A torque acts until the next one does.
      const std::span<const ForceSample> all = desk->model->forces().samples();
      for (std::size_t i = 0; i < all.size(); ++i) {
        const bool over = i + 1 < all.size() && all[i + 1].time <= began + from;
        if (over || all[i].time > began + to) continue;
        result = choose(result, std::abs(all[i].torque[0]));
      }
      return result;
    });
  }
  void report(const char* what, double torque) {
    std::printf("| %-48s | %7.3f N m |\n", (std::string(kName<Model>) + ": " + what).c_str(),
                torque);
  }

  static constexpr double kStart = 1.2;  // [s]
  ArmDescription arm = joystick_arm();
  SafetyLimits limits;
  std::unique_ptr<Desk<Model>> desk;
  Time began{};
};
TYPED_TEST_SUITE(LimitedLoop, Models);

TYPED_TEST(LimitedLoop, FadesWhenAJointIsFasterThan15RadiansASecond) {
  this->open(24);  // 25 ms for 0.6 rad; the force is gone at 22.5
  wait(1400ms);
  EXPECT_GT(this->most(-50ms, 0ms), 0.4);
  const double torque = this->least(10ms, 28ms);
  this->report("joint at 24 rad/s", torque);
  EXPECT_EQ(torque, 0);
  wait(700ms);
  EXPECT_GT(this->most(700ms, 900ms), 0.4) << "it comes back by itself";
}

TYPED_TEST(LimitedLoop, FadesWhenTheTipIsFasterThan2MetresASecond) {
  this->arm.tip.translation() *= 3;  // 0.36 m: 9 rad/s are 3.2 m/s; the force is gone at 3
  this->open(9);
  wait(1400ms);
  EXPECT_GT(this->most(-50ms, 0ms), 0.4);
  const double torque = this->least(20ms, 70ms);
  this->report("tip at 3.2 m/s", torque);
  EXPECT_EQ(torque, 0);
}

TYPED_TEST(LimitedLoop, FadesBeyondTheRangeOfAJoint) {
  this->arm.joints[0].upper = 0.1;
  this->open(1);
  wait(2000ms);
  EXPECT_GT(this->most(0ms, 300ms), 0.4);
  EXPECT_NEAR(this->most(450ms, 450ms + 1ms), 0.25, 0.1);  // halfway beyond the limit
  const double torque = this->most(550ms, 800ms);
  this->report("0.2 rad beyond the range", torque);
  EXPECT_EQ(torque, 0);
  EXPECT_EQ(this->desk->force_state(), ForceState::too_far);
}

TYPED_TEST(LimitedLoop, PushesWithTenNewtonsAtMost) {
  this->open(0.5, 5);  // 5 N m at 0.12 m would be 42 N
  wait(2500ms);
  const double torque = this->most(-500ms, 1200ms);
  this->report("10 N at 0.12 m", torque);
  EXPECT_LE(torque, 10 * 0.12 + 5.0 / 127) << "and a step of the coarsest";
  EXPECT_GE(torque, 10 * 0.12 * 0.9);
}

// 5 N m over 0.6 rad would be 3 J, with 2.25 allowed: the force fades as the rest decreases.
TYPED_TEST(LimitedLoop, FadesWhenTheMotorsPutOutTooMuchEnergy) {
  constexpr double kRate = 2.5;      // of the way back [rad/s]
  this->arm.tip.translation() *= 5;  // 10 N at 0.6 m
  this->open(0.6, 5);
  wait(2500ms);  // led against the force: energy goes in
  ASSERT_EQ(this->desk->force_state(), ForceState::on);
  ASSERT_GT(this->most(1000ms, 1200ms), 4);
  this->began = this->desk->device->with([&](Time now) {
    SprungHand& hand = this->desk->model->hand();
    hand.axis(0).path = [](double t) { return std::clamp(0.3 - kRate * t, -0.3, 0.3); };
    hand.begin(now);
    return now;
  });
  wait(240ms);
  EXPECT_EQ(this->desk->force_state(), ForceState::energy);
  double work = 0, torque = 0;
  this->desk->device->with([&](Time now) {
    Time last = this->began;
    for (const ForceSample& sample : this->desk->model->forces().samples()) {
      if (sample.time > this->began) {
        work += torque * kRate * std::chrono::duration<double>(sample.time - last).count();
        last = sample.time;
      }
      torque = -sample.torque[0];
    }
    EXPECT_LT(now - last, 5ms);
  });
  std::printf("| %-48s | %7.3f J, then %.2f of 5 N m |\n", kName<TypeParam>, work, torque);
  EXPECT_GT(work, 1.5);
  EXPECT_LT(work, 2.5);
  EXPECT_LT(torque, 2);
}

TYPED_TEST(LimitedLoop, IsZeroWhenTheLoopBecomesUnstable) {
  this->open(0.5);
  wait(1000ms);
  ASSERT_LT(this->desk->torque(), -0.4);
  const Time moment = steady_now();
  this->desk->set([](Controls& controls) { controls.parameters().k_vc = NAN; });
  wait(100ms);
  const auto zero = this->desk->zero_after(moment);
  print_time(std::string(kName<TypeParam>) + ": unstable (and a frame)", zero, 25ms);
  ASSERT_TRUE(zero);
  EXPECT_LE(*zero, 25ms);
  EXPECT_EQ(this->desk->force_state(), ForceState::diverged);
}

TYPED_TEST(LimitedLoop, ObeysTheLowerLimitsOfItsUser) {
  this->limits = {.tip_speed = 0.06, .tip_force = 2};
  this->open(0.6);  // 0.072 m/s: 0.6 of the force is left
  wait(2000ms);
  EXPECT_NEAR(this->most(-200ms, 0ms), 2 * 0.12, 0.01);
  EXPECT_LT(this->most(300ms, 900ms), 0.9 * 2 * 0.12);
}

}  // namespace
}  // namespace limpid::test
