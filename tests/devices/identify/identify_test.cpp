// Identification of devices that differ from their file, by moving them.
#include <gtest/gtest.h>

#include <numbers>

#include "devices/identify/excitation.h"
#include "devices/identify/fit.h"
#include "devices/identify/unlike_device.h"
#include "tests/devices/identify/moved.h"
#include "tests/support/built_in.h"
#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::moved;
using test::Random;

Eigen::MatrixXd inertia_at(const ArmDescription& description, const Vec<kAnyDof>& x) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  Mat<kAnyDof> M;
  arm.frames(x, f);
  arm.inertia(f, M);
  return M;
}

Eigen::VectorXd weight_at(const ArmDescription& description, const Vec<kAnyDof>& x,
                          const Vec3& gravity) {
  const Vec<kAnyDof> zero = Vec<kAnyDof>::Zero(description.dof());
  return regressor(Arm<kAnyDof>(description), x, zero, zero, gravity) * parameters_of(description);
}

// Expects the true inertia and weight in poses of the motion, friction and delay.
void expect_found(const ArmDescription& truth, const Unlikeness& bench, const Identified& found,
                  const MotionRecord& record, Random& random) {
  double heaviest = 0, wrong = 0;
  for (int pose = 0; pose < 20; ++pose) {
    const auto row =
        static_cast<Eigen::Index>(random.between(0, 1) * static_cast<double>(record.rows() - 1));
    const Eigen::VectorXd x = record.x.row(row);
    const Eigen::MatrixXd M = inertia_at(truth, x), got = inertia_at(found.arm, x);
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      for (Eigen::Index j = 0; j < M.cols(); ++j) {
        EXPECT_NEAR(got(i, j), M(i, j), 0.05 * std::sqrt(M(i, i) * M(j, j))) << i << ", " << j;
      }
    }
    // Weight may be attributed to a spring and an offset instead.
    Eigen::VectorXd weight = weight_at(truth, x, bench.gravity);
    Eigen::VectorXd said = weight_at(found.arm, x, bench.gravity);
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const JointFinding& joint = found.joints[static_cast<std::size_t>(j)];
      said[j] += joint.offset.value + joint.spring.value * x[j];
      if (bench.spring.size() > 0) weight[j] += bench.spring[j] * x[j] + bench.offset[j];
    }
    heaviest = std::max(heaviest, weight.norm());
    wrong = std::max(wrong, (said - weight).norm());
  }
  EXPECT_LT(wrong, 0.05 * heaviest + 1e-4);
  for (std::size_t j = 0; j < truth.joints.size(); ++j) {
    const JointFinding& joint = found.joints[j];
    EXPECT_NEAR(joint.coulomb.value, truth.joints[j].friction,
                0.1 * truth.joints[j].friction + 1e-4);
    EXPECT_NEAR(joint.viscous.value, truth.joints[j].damping, 0.1 * truth.joints[j].damping);
    EXPECT_LT(joint.residual, 0.05 * joint.torque);
  }
  EXPECT_NEAR(found.delay.value, 1e-3 * bench.delay, 0.5e-3);
}

void expect_found(const ArmDescription& guess, Unlikeness bench, unsigned seed) {
  Random random(seed);
  const ArmDescription truth = unlike(guess, seed, 0.03);
  UnlikeDevice device(truth, bench);
  Excitation motion(guess, device.traits(), {});
  const MotionRecord record = moved(device, motion);
  SCOPED_TRACE(testing::Message() << guess.name << ", seed " << seed << ", "
                                  << explain(motion.end()) << " after " << motion.time() << " s");
  ASSERT_EQ(motion.end(), ExcitationEnd::complete);
  expect_found(truth, bench, identify(guess, record, {.gravity = bench.gravity}), record, random);
}

const Vec3 kDown(0, 0, -9.81);

TEST(Identify, FindsADevicesInertiaWeightFrictionAndDelay) {
  expect_found(test::omni(), {.gravity = kDown, .encoder_step = 3e-5, .delay = 2}, 501);
  expect_found(test::omni(), {.gravity = kDown, .encoder_step = 1e-4, .delay = 4}, 502);
}

// An encoder of about 1000 steps over a joint's range.
TEST(Identify, FindsThemThroughCoarseEncoders) {
  expect_found(test::omni(), {.gravity = kDown, .encoder_step = 2e-3, .delay = 3}, 503);
  expect_found(test::omni(), {.gravity = kDown, .encoder_step = 2e-3, .delay = 1}, 504);
}

TEST(Identify, FindsSpringsThatCentreAStick) {
  const ArmDescription stick = read_urdf(test::assets_dir() / "devices/joystick.urdf");
  Unlikeness bench{.encoder_step = 5e-4, .delay = 1};
  bench.spring = Eigen::Vector2d(0.12, 0.2);
  bench.offset = Eigen::Vector2d(0.01, -0.02);
  Random random(505);
  const ArmDescription truth = unlike(stick, 505, 0.02);
  UnlikeDevice device(truth, bench);
  Excitation motion(stick, device.traits(), {});
  const MotionRecord record = moved(device, motion);
  ASSERT_EQ(motion.end(), ExcitationEnd::complete);
  const Identified found = identify(stick, record, {});
  expect_found(truth, bench, found, record, random);
  for (Eigen::Index j = 0; j < 2; ++j) {
    const JointFinding& joint = found.joints[static_cast<std::size_t>(j)];
    EXPECT_NEAR(joint.spring.value, bench.spring[j], 0.05 * bench.spring[j]);
    EXPECT_NEAR(joint.offset.value, bench.offset[j], 0.05 * std::abs(bench.offset[j]) + 5e-4);
  }
}

TEST(Identify, SaysWhichJointMovedTooLittle) {
  const ArmDescription stick = read_urdf(test::assets_dir() / "devices/joystick.urdf");
  MotionRecord record;
  record.x = record.torque = Eigen::MatrixXd::Zero(20000, 2);
  for (Eigen::Index i = 0; i < record.rows(); ++i) {
    record.x(i, 0) = 0.3 * std::sin(0.004 * static_cast<double>(i));
  }
  try {
    identify(stick, record, {});
    FAIL() << "it did not move";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr(stick.joints[1].name));
    EXPECT_THAT(e.what(), testing::HasSubstr("moved too little"));
  }
}

// A known motion of one joint with the torques of its equation of motion, late by the delay and
// with noise.
MotionRecord swung(const ArmDescription& arm, double delay, double noise, unsigned seed) {
  using std::numbers::pi;
  Random random(seed);
  const Arm<kAnyDof> model(arm);
  const Eigen::VectorXd links = parameters_of(arm);
  MotionRecord record;
  record.x.resize(8000, 1);
  record.torque.resize(8000, 1);
  const auto motion = [](double t, int derivative) {
    double sum = 0;
    for (const auto& [amplitude, frequency, phase] :
         {std::array{0.5, 0.7, 0.0}, std::array{0.2, 1.9, 1.0}}) {
      const double w = 2 * pi * frequency;
      sum += amplitude * std::pow(w, derivative) * std::sin(w * t + phase + derivative * pi / 2);
    }
    return Vec<kAnyDof>(Vec<kAnyDof>::Constant(1, sum));
  };
  for (Eigen::Index i = 0; i < record.rows(); ++i) {
    record.x(i, 0) = motion(record.T * double(i), 0)[0];
    const double t = record.T * (double(i) + 0.5) + delay;  // middle of the torque's action
    record.torque(i, 0) =
        (regressor(model, motion(t, 0), motion(t, 1), motion(t, 2), kDown) * links)[0] +
        random.between(-noise, noise);
  }
  return record;
}

// Errors in standard deviations have a mean square of 1, to within three of its own deviations. The
// noise is weak beside the torque's change with the delay, as the formula assumes.
TEST(Identify, SaysHowFarItsDelayMayBeOff) {
  const ArmDescription arm = test::random_arm(1, 41);
  constexpr double kDelay = 3e-3;
  const double torque = swung(arm, kDelay, 0, 0).torque.norm() / std::sqrt(8000.0);
  constexpr int kTimes = 60;
  double square = 0;
  for (unsigned seed = 0; seed < kTimes; ++seed) {
    const MotionRecord record = swung(arm, kDelay, 0.04 * torque, 900 + seed);
    const Found delay = identify(arm, record, {.gravity = kDown}).delay;
    ASSERT_LT(delay.deviation, 3e-4);
    square += std::pow((delay.value - kDelay) / delay.deviation, 2) / kTimes;
  }
  EXPECT_NEAR(square, 1, 3 * std::sqrt(2.0 / kTimes));
}

}  // namespace
}  // namespace limpid
