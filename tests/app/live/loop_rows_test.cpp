// Ticks of the loop, and the controls, as its rows and snapshots tell of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "app/live/live_loop.h"
#include "app/run/replay.h"
#include "core/dynamics/arm.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"
#include "tests/support/wired_device.h"

namespace limpid {
namespace {

// A loop of the built-in arm; a test looks at its newest rows.
class ALoop : public testing::Test {
 protected:
  void open(const SceneDocument& document) {
    loop_.set(controls_);
    loop_.open(test::omni(), document.scene, controls_.parameters(), Vec3(0.19, 0, 0));
  }
  // Waits for a snapshot that is as wanted.
  template <class Wanted>
  bool comes(Wanted wanted) {
    return test::until([&] {
      loop_.set(controls_);
      return loop_.update() && wanted(loop_.snapshot());
    });
  }
  std::span<const double> in_newest(Column c) const {
    return loop_.layout().in(std::span<const double>(loop_.snapshot().row), c);
  }
  Vec3 vec_in_newest(Column c) const { return Vec3(in_newest(c).data()); }

  Controls controls_;
  LiveLoop loop_{{}};
};

// The window took nothing for so long that rows found no room. It takes a number of rows that does
// not divide the ring's. The arm counts its time in ticks of 0.1 ms.
TEST_F(ALoop, NumbersItsTicksAsTheArmCountsThemAlsoAfterAGap) {
  controls_.parameters().tick = 1e-4;
  open(test::omni_document("free.toml"));
  ASSERT_TRUE(test::until([this] { return loop_.trace_dropped() > 2000; }));
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  std::vector<double> rows(300 * kMostLanes * stride);
  std::uint64_t before = 0, after = 0, furthest = 0;
  const auto look_at = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = std::span<const double>(rows).subspan(i * kMostLanes * stride, stride);
      const double t = loop_.layout().in(row, Column::time)[0];
      const auto counted = static_cast<std::uint64_t>(std::llround(t / 1e-4));
      const std::uint64_t number = loop_.drained_from() + i;
      furthest = std::max(furthest, std::max(counted, number) - std::min(counted, number));
      ++(number < 8192 ? before : after);
    }
  };
  ASSERT_TRUE(test::until([&] {
    look_at(loop_.drain(rows));
    return after > 500;
  }));
  EXPECT_EQ(before, 8192u) << "all that the ring holds";
  EXPECT_LT(furthest, 1000u) << "of more than 2000 that were lost";
}

TEST_F(ALoop, SaysHowFarItHasFollowedAPath) {
  open(test::omni_document("free.toml"));
  const HandPath path =
      hand_through({0, 5}, {Vec3(0.19, 0, 0), Vec3(0.2, 0.02, 0.01)}, "a slow hand");
  const auto lead = [&](bool waits) {
    loop_.lead(std::make_unique<LedPath>(LedPath{path, waits}));
  };
  // The next sample is that at `led`: the row's own is a tick before.
  const auto is_led_to = [&](double t) {
    return (vec_in_newest(Column::hand_target) - path.at(t)).norm() < 1e-12;
  };
  lead(false);
  ASSERT_TRUE(comes([](const Snapshot& now) { return now.led > 0.05; }));
  EXPECT_TRUE(is_led_to(loop_.snapshot().led - 1e-3));
  const double before = loop_.snapshot().led;
  ++controls_.resets;
  ASSERT_TRUE(comes([&](const Snapshot& now) { return now.led < before; }));
  EXPECT_TRUE(is_led_to(loop_.snapshot().led - 1e-3)) << "it begins again";
  lead(true);
  ASSERT_TRUE(comes([&](const Snapshot& now) { return now.led == 0; }));
  ASSERT_TRUE(comes([&](const Snapshot&) { return in_newest(Column::time)[0] > 0.1; }));
  EXPECT_EQ(loop_.snapshot().led, 0) << "it waits";
  EXPECT_TRUE(is_led_to(0));
  loop_.lead(std::make_unique<LedPath>());
  controls_.grab = true;
  controls_.goal = Vec3(0.18, 0.01, 0);
  EXPECT_TRUE(comes([&](const Snapshot&) {
    return (vec_in_newest(Column::hand_target) - controls_.goal).norm() < 1e-4 &&
           in_newest(Column::hand_grip)[0] == 1;
  })) << "the mouse leads again";
}

TEST_F(ALoop, PullsBodiesAndUsesTheMagnetAsItIsToldTo) {
  open(test::omni_document("dial.toml"));
  ASSERT_TRUE(comes([&](const Snapshot&) { return true; }));
  EXPECT_EQ(in_newest(Column::hand_magnet)[0], 0);
  EXPECT_EQ(in_newest(Column::hand_pull)[0], 0);
  controls_.magnet = true;
  controls_.pull = {0, Vec3(0.001, 0.002, 0.003), Vec3(0.2, 0.01, 0.02)};
  ASSERT_TRUE(comes([&](const Snapshot&) { return in_newest(Column::hand_magnet)[0] == 1; }));
  EXPECT_EQ(in_newest(Column::hand_pull)[0], 1) << "counted from 1";
  EXPECT_EQ(vec_in_newest(Column::pull_point), controls_.pull.point);
  EXPECT_EQ(vec_in_newest(Column::pull_target), controls_.pull.target);
  controls_.magnet = false;
  controls_.pull = {};
  ASSERT_TRUE(comes([&](const Snapshot&) { return in_newest(Column::hand_magnet)[0] == 0; }));
  EXPECT_EQ(in_newest(Column::hand_pull)[0], 0);
}

TEST_F(ALoop, TouchesAnotherSceneFromTheNextTickOn) {
  open(test::omni_document("free.toml"));
  controls_.grab = true;
  controls_.goal = Vec3(0.19, 0, -0.005);
  ASSERT_TRUE(comes([&](const Snapshot&) { return in_newest(Column::time)[0] > 0.05; }));
  EXPECT_EQ(vec_in_newest(Column::contact_torque).norm(), 0);
  Scene floor;
  floor.add({"floor", Pose::Identity(), Plane{Vec3::UnitZ()}, {500}});
  loop_.exchange(std::make_unique<TouchWorlds>(test::omni(), floor));
  EXPECT_TRUE(
      comes([&](const Snapshot&) { return vec_in_newest(Column::contact_torque).norm() > 1e-3; }));
  loop_.exchange(std::make_unique<TouchWorlds>(test::omni(), Scene{}));
  EXPECT_TRUE(
      comes([&](const Snapshot&) { return vec_in_newest(Column::contact_torque).norm() == 0; }));
}

// The row of a recording that a tick of the loop became; the recording's first row has the time 0.
TEST_F(ALoop, KnowsTheRowsOfTheRecordingThatItsTicksAre) {
  const test::TempDir dir;
  const SceneDocument free = test::omni_document("free.toml");
  open(free);
  ASSERT_TRUE(comes([&](const Snapshot&) { return in_newest(Column::time)[0] > 0.1; }));
  RunPlan plan;
  plan.arm = test::omni();
  plan.document = free;
  plan.parameters = controls_.parameters();
  EXPECT_FALSE(loop_.recording());
  loop_.record(
      std::make_unique<Recorder>(dir / "a.h5", session_info(plan), plan.parameters, false));
  EXPECT_TRUE(loop_.recording());
  ASSERT_TRUE(
      comes([&](const Snapshot& now) { return now.recording && loop_.recorder()->rows() > 100; }));
  loop_.mark({40, "here"});
  loop_.stop_recording();
  EXPECT_FALSE(loop_.recording());
  ASSERT_TRUE(comes([](const Snapshot& now) { return !now.recording; }));
  const std::uint64_t recorded = loop_.recorder()->rows();
  const auto stride = static_cast<std::size_t>(loop_.layout().stride());
  std::vector<double> rows(4096 * kMostLanes * stride);
  const std::size_t count = loop_.drain(rows);
  std::size_t begin = 0;  // the tick at which time starts again
  const auto time_of = [&](std::size_t i) {
    return loop_.layout().in(std::span<const double>(rows).subspan(i * kMostLanes * stride, stride),
                             Column::time)[0];
  };
  for (std::size_t i = 1; i < count && begin == 0; ++i) begin = time_of(i) < time_of(i - 1) ? i : 0;
  ASSERT_GT(begin, 50u);
  EXPECT_EQ(loop_.drained_from(), 0u);
  EXPECT_EQ(time_of(begin), 0);
  EXPECT_EQ(loop_.recorded_row(begin), 0u);
  EXPECT_EQ(loop_.recorded_row(begin + 1), 1u);
  EXPECT_EQ(loop_.recorded_row(begin + 77), 77u);
  EXPECT_EQ(loop_.recorded_row(3), 0u) << "from before the recording";
  EXPECT_EQ(loop_.recorded_row(begin + 1'000'000), recorded - 1) << "from after it";
  loop_.finish_recording();
  const Session session = read_session(dir / "a.h5");
  EXPECT_EQ(session.size(), recorded);
  EXPECT_EQ(session.marks, (std::vector<Mark>{{40, "here"}}));
}

TEST_F(ALoop, TogglesTheVirtualArmsForceAtOnce) {
  open(test::omni_document("free.toml"));
  ASSERT_TRUE(comes([](const Snapshot& now) { return now.arming == Arming::on; }));
  EXPECT_TRUE(loop_.snapshot().armed());
  EXPECT_EQ(loop_.snapshot().force_state, ForceState::on);
  EXPECT_TRUE(loop_.toggle_force());
  ASSERT_TRUE(comes([](const Snapshot& now) { return now.arming == Arming::off; }));
  EXPECT_FALSE(loop_.snapshot().armed());
  EXPECT_TRUE(loop_.toggle_force());
  EXPECT_TRUE(comes([](const Snapshot& now) { return now.arming == Arming::on; }));
}

TEST_F(ALoop, SaysWhichDeviceItHas) {
  EXPECT_FALSE(loop_.holds_device());
  EXPECT_EQ(loop_.device_source(), "");
  auto device = std::make_unique<test::FakeDevice>(3);
  Eigen::Map<Eigen::Vector3d>(device->reading.x.data()) = rest_pose(test::omni());
  device->reading.x[0] += 0.125;
  const std::string source = "device: " + device_text(device->traits());
  loop_.open(test::omni(), Scene{}, controls_.parameters(), std::move(device));
  EXPECT_TRUE(loop_.device_in_place());
  EXPECT_TRUE(loop_.device_plugged());
  EXPECT_TRUE(loop_.holds_device());
  EXPECT_EQ(loop_.device_source(), source);
  ASSERT_TRUE(comes([](const Snapshot& now) { return now.connected; }));
  EXPECT_EQ(loop_.snapshot().reading.x[0], rest_pose(test::omni())[0] + 0.125);
  EXPECT_NEAR(in_newest(Column::device_position)[0], rest_pose(test::omni())[0] + 0.125, 1e-9);
  loop_.plug(nullptr);
  EXPECT_FALSE(loop_.device_plugged());
  ASSERT_TRUE(comes([](const Snapshot& now) { return !now.connected; }));
  EXPECT_TRUE(loop_.device_in_place()) << "it may come back";
  EXPECT_EQ(loop_.device_source(), source) << "of the one that was plugged in last";
  EXPECT_TRUE(test::until([this] {
    loop_.update();
    return !loop_.holds_device();
  }));
  loop_.close();
  EXPECT_FALSE(loop_.device_in_place());
}

// A device that goes away trips the force once, however long it is away; one that is cut does not.
TEST_F(ALoop, CountsHowOftenADevicesForceTripped) {
  const auto wire = std::make_shared<test::Wire>();
  loop_.open(test::omni(), Scene{}, controls_.parameters(),
             std::make_unique<test::WiredDevice>(3, wire));
  const auto gets_force = [this] {
    return comes([this](const Snapshot& now) {
      if (!now.armed()) loop_.arm();
      return now.arming == Arming::on;
    });
  };
  EXPECT_EQ(loop_.trips(), 0u);
  for (std::uint64_t trips = 0; trips < 2; ++trips) {
    ASSERT_TRUE(gets_force());
    const std::uint64_t before = loop_.trips();
    wire->here = false;
    ASSERT_TRUE(comes([](const Snapshot& now) { return now.arming == Arming::tripped; }));
    EXPECT_EQ(loop_.trips(), before + 1);
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(comes([](const Snapshot&) { return true; }));
    EXPECT_EQ(loop_.trips(), before + 1) << "the same one";
    wire->here = true;
  }
  ASSERT_TRUE(gets_force());
  const std::uint64_t before = loop_.trips();
  loop_.cut();
  ASSERT_TRUE(comes([](const Snapshot& now) { return now.arming == Arming::off; }));
  EXPECT_EQ(loop_.trips(), before) << "nothing tripped";
}

}  // namespace
}  // namespace limpid
