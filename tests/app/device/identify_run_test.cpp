#include "app/device/identify_run.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "devices/files/urdf_file.h"
#include "devices/identify/unlike_device.h"

namespace limpid {
namespace {

ArmDescription omni() { return read_urdf(LIMPID_ASSETS_DIR "/devices/omni.urdf"); }

// The smallest force at the tip that makes the torque [N].
double tip_force(const ArmDescription& description, const Eigen::VectorXd& x,
                 const Eigen::VectorXd& torque) {
  const Arm<kAnyDof> arm(description);
  Arm<kAnyDof>::Frames f;
  Jacobian<kAnyDof> J;
  arm.frames(x, f);
  arm.point_jacobian(f, arm.dof() - 1, arm.tip(f), J);
  return ((J * J.transpose()).inverse() * (J * torque)).norm();
}

TEST(IdentifyRun, KeepsWithinTheLimitsThatAreSetForTheDevice) {
  SafetyLimits set;
  set.tip_force = 0.4;
  set.range = 0.3;
  const ArmDescription arm = omni();
  const ExcitationPlan plan = within({}, set);
  EXPECT_EQ(plan.limits.tip_force, 0.4);
  EXPECT_LT(plan.range, 0.3);
  EXPECT_EQ(plan.limits.energy, ExcitationPlan{}.limits.energy) << "no limit is widened";
  UnlikeDevice device(arm, {.encoder_step = 1e-4});
  IdentifyProgress progress;
  const IdentifyRun run = simulate_identification(device, arm, plan, progress);
  EXPECT_EQ(run.end, ExcitationEnd::complete);
  double most = 0;
  for (Eigen::Index i = 0; i < run.record.rows(); i += 10) {
    most = std::max(most, tip_force(arm, run.record.x.row(i), run.record.torque.row(i)));
  }
  EXPECT_LT(most, 0.4 * 1.05) << "a reading's change within the slew";
  EXPECT_GT(most, 0.1) << "it pushed";
}

// Each torque's share has decayed since it acted, by the theory of systems of first order.
TEST(IdentifyRun, TellsByHowMuchTheMotorsWereWarmedUp) {
  ArmDescription arm = omni();
  constexpr double kContinuous = 0.05, kTime = 60, kTick = 1e-3;
  arm.joints[1].continuous = kContinuous;
  arm.joints[1].warming = kTime;
  UnlikeDevice device(arm, {.encoder_step = 1e-4});
  IdentifyProgress progress;
  const IdentifyRun run = simulate_identification(device, arm, {}, progress);
  ASSERT_EQ(run.end, ExcitationEnd::complete);
  double expected = 0;
  const Eigen::Index rows = run.record.rows();
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double left = std::exp(-kTick * static_cast<double>(rows - k) / kTime);
    expected += std::pow(run.record.torque(k, 1) / kContinuous, 2) * left * kTick / kTime;
  }
  ASSERT_GT(expected, 0.01);
  EXPECT_NEAR(run.warmth[1], expected, 1e-3 * expected);
  EXPECT_EQ(run.warmth[0], 0) << "no model";
}

// A device that has not sent a position.
class Mute final : public Device {
 public:
  Mute() : traits_(UnlikeDevice(omni(), {}).traits()) {}
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    newest = {};
    return true;
  }
  void write(std::span<const double> torque) noexcept override {
    for (const double t : torque) pushed = pushed || t != 0;
  }
  void stop() noexcept override {}
  bool pushed = false;

 private:
  DeviceTraits traits_;
};

TEST(IdentifyRun, DoesNotPushADeviceThatHasNotSaidWhereItIs) {
  Mute device;
  IdentifyProgress progress;
  const IdentifyRun run = simulate_identification(device, omni(), {}, progress);
  EXPECT_EQ(run.end, ExcitationEnd::not_well);
  EXPECT_FALSE(device.pushed);
}

// A device that stands still. It answers late once, and wants to end after some readings.
class LateOnce final : public Device {
 public:
  explicit LateOnce(IdentifyProgress& progress)
      : traits_(UnlikeDevice(omni(), {}).traits()), progress_(progress) {
    UnlikeDevice(omni(), {}).read(rest);
    rest.age = 0;
  }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    rest.count = ++reads;
    if (reads == 20) std::this_thread::sleep_for(std::chrono::milliseconds(12));
    if (reads == 60) progress_.cancel = true;
    newest = rest;
    return true;
  }
  void write(std::span<const double> torque) noexcept override {
    for (const double t : torque) most = std::max(most, std::abs(t));
  }
  void stop() noexcept override { ++stops; }

  DeviceReading rest;
  std::uint64_t reads = 0;
  int stops = 0;
  double most = 0;  // [N m]

 private:
  DeviceTraits traits_;
  IdentifyProgress& progress_;
};

// Ticks that were given up have rows of their own: time in the record is the time that passed.
TEST(IdentifyRun, HasARowForEachTickThatWasMissed) {
  IdentifyProgress progress;
  LateOnce device(progress);
  const IdentifyRun run = run_identification(device, omni(), {}, progress, {});
  EXPECT_NE(run.end, ExcitationEnd::running);
  EXPECT_NE(run.end, ExcitationEnd::complete);
  EXPECT_GE(device.stops, 1);
  ASSERT_GE(device.reads, 20u);
  const Eigen::Index rows = run.record.rows();
  EXPECT_GE(rows, static_cast<Eigen::Index>(device.reads) + 8) << "at least 12 ms passed at once";
  for (Eigen::Index k = 0; k < rows; ++k) {
    for (Eigen::Index joint = 0; joint < 3; ++joint) {
      ASSERT_EQ(run.record.x(k, joint), device.rest.x[static_cast<std::size_t>(joint)]) << k;
      ASSERT_LE(std::abs(run.record.torque(k, joint)), device.most) << k;
    }
  }
  EXPECT_EQ(run.record.T, 1e-3);
  const ReadingTimes& timing = run.timing;
  EXPECT_EQ(timing.intervals.size(), device.reads - 1) << "between two readings each";
  double sum = 0, longest = 0;
  for (const double each : timing.intervals) {
    sum += each;
    longest = std::max(longest, each);
  }
  EXPECT_EQ(timing.most, longest);
  EXPECT_GE(timing.most, 0.012);
  EXPECT_LE(timing.p50, timing.p99);
  EXPECT_LE(timing.p99, timing.most);
  EXPECT_NEAR(timing.rate * sum, static_cast<double>(device.reads - 1), 1e-6);
  EXPECT_GT(progress.duration, 1);
  EXPECT_GT(progress.time, 0);
}

}  // namespace
}  // namespace limpid
