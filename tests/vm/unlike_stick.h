// Sticks that differ from the joystick's file, to be identified.
#pragma once

#include <gtest/gtest.h>

#include "devices/identify/fit.h"
#include "tests/support/hid/raw_device_model.h"
#include "tests/support/random_arm.h"
#include "tests/vm/leaning_hand.h"

namespace limpid::test {

struct UnlikeStick {
  RawDeviceLayout layout{.joints = 2, .torque_limit = kEffort};
  std::array<AxisPhysics, 2> axes;

  // A random stick: inertia half to twice the file's, friction to 0.03 N m, weight, a spring;
  // `bits` of an axis, `lag`.
  UnlikeStick(unsigned seed, int bits, Time lag) {
    Random random(seed);
    layout.lag = lag;
    layout.resolution = 2 * kRange / ((1 << bits) - 1);
    for (int i = 0; i < 2; ++i) {
      AxisPhysics axis = stick_axis(i);
      axis.inertia *= std::exp2(random.between(-1, 1));
      axis.coulomb = random.between(0.003, 0.03);
      axis.friction = random.between(0.003, 0.02);
      axis.weight = random.between(0.01, 0.06);
      axis.stiffness = random.between(0.05, 0.2);
      axis.damping = 0;
      axes[static_cast<std::size_t>(i)] = axis;
    }
  }

  std::unique_ptr<RawDeviceModel> made() const {
    auto model = std::make_unique<RawDeviceModel>(layout);
    for (int i = 0; i < 2; ++i) model->hand().axis(i) = axes[static_cast<std::size_t>(i)];
    return model;
  }

  // Compares with the truth; `way` is the time from a reading to the device's reception of the
  // answer, without its own lag [s].
  void expect_found(const Identified& found, double way) const {
    const double lag = std::chrono::duration<double>(layout.lag).count();
    EXPECT_NEAR(found.delay.value, way + lag, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {
      SCOPED_TRACE(testing::Message() << "axis " << i + 1);
      const AxisPhysics& axis = axes[i];
      const JointFinding& joint = found.joints[i];
      EXPECT_NEAR(joint.inertia.value, axis.inertia, 0.05 * axis.inertia);
      EXPECT_NEAR(joint.coulomb.value, axis.coulomb, 0.1 * axis.coulomb);
      EXPECT_NEAR(joint.viscous.value, axis.friction, 0.1 * axis.friction);
      // Pull of spring and weight together at 0.2 rad: which of the two pulls is not told apart.
      Vec<kAnyDof> x = found.middle;
      const double before = pull_at(found, x, i);
      x[static_cast<Eigen::Index>(i)] += 0.2;
      const double rise = axis.stiffness * 0.2 - axis.weight * std::sin(0.2);
      const double largest = axis.stiffness * 0.2 + axis.weight * std::sin(0.2);
      EXPECT_NEAR(pull_at(found, x, i) - before, rise, 0.05 * largest);
    }
  }

 private:
  static double pull_at(const Identified& found, const Vec<kAnyDof>& x, std::size_t joint) {
    const Arm<kAnyDof> arm(found.arm);
    const Vec<kAnyDof> zero = Vec<kAnyDof>::Zero(2);
    const auto j = static_cast<Eigen::Index>(joint);
    return (regressor(arm, x, zero, zero, Vec3(0, 0, -9.81)) * parameters_of(found.arm))[j] +
           found.joints[joint].spring.value * x[j];
  }
};

}  // namespace limpid::test
