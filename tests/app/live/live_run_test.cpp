// A device led by a command, without a window.
#include "app/live/live_run.h"

#include <cmath>

#include "app/run/replay.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/temp_dir.h"

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
  EXPECT_THROW(run_->pass(5, kNeverStops), std::runtime_error);
}

TEST_F(ALiveRun, EndsWhenItIsToldTo) {
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(run_->pass(100, stop));
}

}  // namespace
}  // namespace limpid
