// Choice of the moments of a record that are used.
#include <gtest/gtest.h>

#include "devices/identify/fit.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

// The joint rests, moves at 1 rad/s from 1 s to 2 s, and rests again; or all of it backwards.
MotionRecord one_stroke(double direction) {
  MotionRecord record;
  record.x.resize(3000, 1);
  for (Eigen::Index i = 0; i < 3000; ++i) {
    record.x(i, 0) = direction * std::clamp(record.T * double(i) - 1, 0.0, 1.0);
  }
  record.torque = record.x;
  return record;
}

bool used(const MotionRecord& record, double time) {
  const Smoothing window{0.01};
  Eigen::VectorXd times(1);
  times << time;
  return equations_of(test::random_arm(1, 7), record, Vec3::Zero(), window, times).A.rows() == 1;
}

// Friction has one sign throughout a window only if the joint moves throughout it: three deviations
// to either side.
TEST(Equations, AreOfMomentsAboutWhichTheJointMovesAllAlong) {
  for (const double direction : {-1.0, 1.0}) {
    const MotionRecord record = one_stroke(direction);
    EXPECT_TRUE(used(record, 1.5));
    EXPECT_TRUE(used(record, 1.034)) << "it set out before the window";
    EXPECT_TRUE(used(record, 1.966)) << "it stops after it";
    EXPECT_FALSE(used(record, 1.015)) << "it sets out in the window's first half";
    EXPECT_FALSE(used(record, 1.985)) << "it stops in its second half";
    EXPECT_FALSE(used(record, 0.5));
  }
}

}  // namespace
}  // namespace limpid
