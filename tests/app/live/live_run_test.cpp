// A device led by a command, without a window.
#include "app/live/live_run.h"

#include <cmath>

#include "app/run/replay.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

const std::atomic<bool> kNeverStops{false};

// A device that sways about the middle of its ranges, one reading a tick.
class Swaying final : public Device {
 public:
  explicit Swaying(std::atomic<bool>& here) : here_(here), middle_(rest_pose(test::omni())) {}
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    const double t = 1e-3 * static_cast<double>(++count_);
    for (int j = 0; j < 3; ++j) {
      newest.x[static_cast<std::size_t>(j)] = middle_[j] + 0.02 * std::sin(3 * t + j);
    }
    newest.count = count_;
    return here_;
  }
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  std::atomic<bool>& here_;
  Eigen::VectorXd middle_;
  DeviceTraits traits_ = test::pushing(3);
  std::uint64_t count_ = 0;
};

class ALiveRun : public testing::Test {
 protected:
  ALiveRun() {
    plan_.arm = test::omni();
    plan_.document = test::omni_document("free.toml");
    plan_.hand.source = "device";
    run_ = std::make_unique<LiveRun>(plan_, SafetyLimits{}, std::make_unique<Swaying>(here_),
                                     AskForPriority{});
  }
  // Whether force is on within `seconds`.
  bool gets_force(double seconds) {
    for (double t = 0; t < seconds && run_->now().arming != Arming::on; t += 0.02) {
      if (run_->now().arming == Arming::off || run_->now().arming == Arming::tripped) run_->arm();
      run_->pass(0.02, kNeverStops);
    }
    return run_->now().arming == Arming::on;
  }

  std::atomic<bool> here_{true};
  RunPlan plan_;
  std::unique_ptr<LiveRun> run_;
};

TEST_F(ALiveRun, HasNoForceUntilItIsArmedAndNoneOnceItIsCut) {
  run_->pass(0.2, kNeverStops);
  EXPECT_EQ(run_->now().arming, Arming::off);
  ASSERT_TRUE(gets_force(20));
  run_->cut();
  run_->pass(0.1, kNeverStops);
  EXPECT_NE(run_->now().arming, Arming::on);
}

TEST_F(ALiveRun, LosesItsForceWhenNobodyLeadsIt) {
  ASSERT_TRUE(gets_force(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  run_->pass(0.02, kNeverStops);
  EXPECT_NE(run_->now().arming, Arming::on);
}

TEST_F(ALiveRun, RecordsEveryTickInARow) {
  const test::TempDir dir;
  run_->pass(0.1, kNeverStops);
  run_->record(std::make_unique<Recorder>(dir / "a.h5", session_info(plan_), plan_.parameters,
                                          false, Recorder::kLiveRoom));
  std::size_t seen = 0;
  EXPECT_TRUE(run_->pass(0.5, kNeverStops, [&](std::span<const double> row) {
    EXPECT_EQ(row.size(), static_cast<std::size_t>(RowLayout(3).stride()));
    ++seen;
  }));
  EXPECT_EQ(run_->finish_recording(), 0u);
  const Session session = read_session(dir / "a.h5");
  EXPECT_GT(session.size(), 100u);
  EXPECT_GT(seen, 100u);
  for (std::size_t k = 1; k < session.size(); ++k) {
    const double periods =
        1e3 * (session.at(k, Column::time)[0] - session.at(k - 1, Column::time)[0]);
    ASSERT_GE(periods, 1 - 1e-6);
    ASSERT_NEAR(periods, std::round(periods), 1e-6);
  }
}

TEST_F(ALiveRun, SaysThatTheDeviceIsGone) {
  run_->pass(0.1, kNeverStops);
  here_ = false;
  EXPECT_EQ(test::refusal<std::runtime_error>([&] { run_->pass(10, kNeverStops); }),
            "the device is disconnected");
}

TEST_F(ALiveRun, EndsWhenItIsToldTo) {
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(run_->pass(100, stop));
}

TEST_F(ALiveRun, HasTheSettingsAndTheSceneThatItIsGiven) {
  const RowLayout layout(3);
  double eta = 0, contact = 0;
  const auto look = [&](std::span<const double> row) {
    eta = layout.in(row, Column::eta)[0];
    for (const double each : layout.in(row, Column::contact_torque)) {
      contact = std::max(contact, std::abs(each));
    }
  };
  run_->pass(0.1, kNeverStops, look);
  EXPECT_EQ(eta, Parameters{}.eta);
  EXPECT_EQ(contact, 0);
  Parameters p = plan_.parameters;
  p.eta = 0.625;
  p.device_delay = 3;
  run_->set(p);
  EXPECT_EQ(run_->taken(p).device_delay, 0) << "a real device has its own";
  run_->pass(0.1, kNeverStops, look);
  EXPECT_EQ(eta, 0.625);
  ASSERT_TRUE(gets_force(20));
  Scene around;  // the tip is 2 cm deep in it from the next tick on
  around.add(
      {"floor", pose_at(rest_tip(plan_.arm) + Vec3(0, 0, 0.02)), Plane{Vec3::UnitZ()}, {100}});
  run_->touch(around);
  run_->pass(0.2, kNeverStops, look);
  EXPECT_GT(contact, 0);
}

TEST_F(ALiveRun, MeasuresTheGripOnceItHasForce) {
  const RowLayout layout(3);
  ASSERT_TRUE(gets_force(20));
  double pushed = 0;
  const auto look = [&](std::span<const double> row) {
    pushed = std::max(pushed, Vec3(layout.in(row, Column::excitation).data()).norm());
  };
  run_->pass(0.1, kNeverStops, look);
  EXPECT_EQ(pushed, 0);
  std::uint32_t asked = 0;
  // A busy computer may take the force away meanwhile.
  ASSERT_TRUE(test::until([&] {
    if (!gets_force(20)) return false;
    pushed = 0;
    run_->measure_grip();
    ++asked;
    run_->pass(0.5, kNeverStops, look);
    return run_->now().arming == Arming::on;
  }));
  EXPECT_GT(pushed, 0);
  EXPECT_EQ(run_->now().probe, asked);
}

}  // namespace
}  // namespace limpid
