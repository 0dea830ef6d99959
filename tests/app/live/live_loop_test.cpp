// The loop behind the window: a recording made while controls change runs again bit for bit.
#include "app/live/live_loop.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "app/run/replay.h"
#include "app/run/scene_meshes.h"
#include "core/base/sanitized.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/computer.h"
#include "tests/support/fake_device.h"
#include "tests/support/random_arm.h"
#include "tests/support/test_session.h"
#include "tests/support/until.h"
#include "tests/support/wired_device.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
const Vec3 kHome(0.19, 0, 0);

SessionInfo info_of(const ArmDescription& arm, const SceneDocument& document, const Parameters& p) {
  RunPlan plan;
  plan.arm = arm;
  plan.document = document;
  plan.hand.source = "mouse";
  plan.parameters = p;
  return session_info(plan);
}

std::unique_ptr<Recorder> recorder(const std::filesystem::path& out, const ArmDescription& arm,
                                   const SceneDocument& document, const Parameters& p) {
  return std::make_unique<Recorder>(out, info_of(arm, document, p), p, false);
}

// Waits until the loop has made so many more ticks.
void let_live(LiveLoop& loop, std::int64_t ticks) {
  const auto until = loop.status().ticks + ticks;
  while (loop.status().ticks < until && loop.status().running) std::this_thread::sleep_for(1ms);
  ASSERT_TRUE(loop.status().running) << loop.status().failure;
}

// Tick number and hand's target of all rows since the last call.
std::vector<std::pair<std::uint64_t, Vec3>> targets(LiveLoop& loop) {
  const RowLayout& layout = loop.layout();
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> rows(1024 * kMostLanes * stride);
  std::vector<std::pair<std::uint64_t, Vec3>> all;
  while (const std::size_t count = loop.drain(rows)) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = std::span<const double>(rows).subspan(i * kMostLanes * stride, stride);
      const auto target = layout.in(row, Column::hand_target);
      all.emplace_back(loop.drained_from() + i, Vec3(target[0], target[1], target[2]));
    }
  }
  return all;
}

std::unique_ptr<LedPath> path_of(bool waits) {
  auto path = std::make_unique<LedPath>();
  path->hand = hand_through({0, 0.1}, {kHome, kHome + Vec3(0.01, 0, 0)}, "test");
  path->waits = waits;
  return path;
}

TEST(LiveLoop, LeadsTheHandAlongAPathTickByTick) {
  LiveLoop loop({});
  loop.open(test::omni(), test::omni_scene("table.toml"), {}, kHome);
  let_live(loop, 5);  // without a path the hand stays at the tip, up to rounding
  loop.lead(path_of(false));
  let_live(loop, 150);
  const auto all = targets(loop);
  const HandPath path = path_of(false)->hand;
  const auto moves = [](const auto& each) { return (each.second - kHome).norm() > 1e-12; };
  const auto first = std::ranges::find_if(all, moves);
  ASSERT_TRUE(first != all.end());
  for (std::size_t k = 1; first + static_cast<std::ptrdiff_t>(k) - 1 != all.end(); ++k) {
    const auto& [tick, target] = *(first + static_cast<std::ptrdiff_t>(k) - 1);
    EXPECT_EQ(target, path.sample(k, 0.001)) << k;
    EXPECT_EQ(tick, all[0].first + static_cast<std::uint64_t>(&*first - &all[0]) + k - 1);
  }
}

// A scene may not fit: it was read for an arm of more joints.
TEST(LiveLoop, GoesOnAsItWasWhereAnArmOrASceneIsRefused) {
  Scene of_another;
  of_another.add({.name = "stop", .shape = JointStop{.joint = 3}});
  LiveLoop loop({});
  loop.open(test::omni(), test::omni_scene("table.toml"), {}, kHome);
  let_live(loop, 5);
  EXPECT_THROW(loop.open(test::omni(), of_another, {}, kHome), std::invalid_argument);
  let_live(loop, 5);
  EXPECT_THROW(loop.open(test::omni(), of_another, {}, std::make_unique<test::FakeDevice>(3)),
               std::invalid_argument);
  let_live(loop, 5);
  EXPECT_FALSE(loop.device_in_place());
  loop.open(test::omni(), Scene{}, {}, std::make_unique<test::FakeDevice>(3));
  let_live(loop, 5);
  EXPECT_THROW(loop.open(test::omni(), of_another, {}, kHome), std::invalid_argument);
  let_live(loop, 5);
  EXPECT_TRUE(loop.device_in_place());
  EXPECT_EQ(loop.layout().dof(), 3);
}

// The virtual arm accepts settings that a device does not get; readers of the settings are told the
// loop's values.
TEST(LiveLoop, SaysWhatItMakesOfSettingsForARealDevice) {
  const ArmDescription arm = test::omni();
  Parameters set;
  set.damping = 5;
  set.torque_limit = 5;
  set.friction = 0.03;
  set.device_delay = 2;
  LiveLoop loop({});
  loop.open(arm, Scene{}, set, kHome);
  EXPECT_EQ(loop.taken(set), set);
  auto device = std::make_unique<test::FakeDevice>(3);
  const double step = encoder_step_of(device->traits());
  loop.open(arm, Scene{}, set, std::move(device));
  const Parameters taken = loop.taken(set);
  EXPECT_TRUE(std::isnan(taken.damping)) << "as the arm's file says";
  EXPECT_TRUE(std::isnan(taken.torque_limit));
  EXPECT_TRUE(std::isnan(taken.friction));
  EXPECT_EQ(taken.device_delay, 0);
  EXPECT_EQ(taken.encoder_step, step);
  set.damping = 1e-4;
  set.torque_limit = 0.1;
  set.encoder_step = 2e-3;
  EXPECT_EQ(loop.taken(set).damping, 1e-4) << "less may be tried";
  EXPECT_EQ(loop.taken(set).torque_limit, 0.1);
  EXPECT_EQ(loop.taken(set).encoder_step, 2e-3);
}

TEST(LiveLoop, HoldsTheHandAtAPathsBeginningUntilARecordingBegins) {
  const test::TempDir dir;
  const ArmDescription arm = test::omni();
  const SceneDocument table = test::omni_document("table.toml");
  LiveLoop loop({});
  loop.open(arm, table.scene, {}, kHome);
  loop.lead(path_of(true));
  let_live(loop, 150);
  const auto all = targets(loop);
  // Before the path begins, the target is the tip, up to rounding.
  auto each = all.begin();
  for (; each != all.end() && each->second != kHome; ++each) {
    ASSERT_LT((each->second - kHome).norm(), 1e-12);
  }
  ASSERT_TRUE(each != all.end());
  for (; each != all.end(); ++each) ASSERT_EQ(each->second, kHome);
  loop.record(recorder(dir / "a.h5", arm, table, {}));
  let_live(loop, 200);
  loop.finish_recording();
  const Session session = read_session(dir / "a.h5");
  const HandPath path = path_of(true)->hand;
  ASSERT_GT(session.size(), 100u);
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto target = session.at(k, Column::hand_target);
    ASSERT_EQ(Vec3(target[0], target[1], target[2]), path.sample(k, 0.001)) << k;
  }
}

TEST(LiveLoop, CountsTicksOverThoseThatFoundNoRoom) {
  LiveLoop loop({});
  Parameters fast;
  fast.tick = 0.0002;
  loop.open(test::omni(), test::omni_scene("table.toml"), fast, kHome);
  while (loop.trace_dropped() == 0 && loop.status().running) std::this_thread::sleep_for(10ms);
  const auto before = targets(loop);
  const std::uint64_t lost = loop.trace_dropped();
  let_live(loop, 50);
  const auto after = targets(loop);
  ASSERT_FALSE(before.empty() || after.empty());
  EXPECT_EQ(before.front().first, 0u);
  EXPECT_GE(after.back().first, before.size() + lost);
  EXPECT_LE(after.back().first + 1, static_cast<std::uint64_t>(loop.status().ticks));
}

TEST(LiveLoop, IsReplayedBitForBitWhateverTheControlsDidMeanwhile) {
  const test::TempDir dir;
  const ArmDescription arm = test::omni();
  const SceneDocument table = test::omni_document("table.toml");
  LiveLoop loop({});
  Controls controls;
  loop.open(arm, table.scene, controls.parameters(), kHome);
  // The arm is in motion when the recording begins.
  controls.grab = true;
  controls.goal = kHome + Vec3(0.02, 0.03, 0.01);
  loop.set(controls);
  let_live(loop, 100);
  loop.record(recorder(dir / "a.h5", arm, table, controls.parameters()));
  bool armed = true;
  for (int i = 0; i < 25; ++i) {
    controls.goal = kHome + Vec3(0.001 * i, -0.002 * i, -0.0025 * i);
    controls.grab = i % 8 != 7;
    if (const bool now = i % 11 < 9; now != armed) {
      armed = now;
      armed ? loop.arm() : loop.cut();
    }
    controls.parameters().kind = static_cast<CouplingKind>(i % 5 == 4 ? 0 : 1 + i / 5 % 2);
    controls.parameters().eta = 0.7 + 0.1 * i;
    if (i == 10) controls.parameters().velocity = VelocitySource::lowpass;
    if (i == 12) controls.parameters().damping = 0.02;
    if (i == 16) controls.parameters().damping = kFromArm;
    loop.set(controls);
    let_live(loop, 40);
  }
  EXPECT_EQ(loop.recorder()->dropped(), 0u);
  loop.finish_recording();
  EXPECT_FALSE(loop.recording());
  loop.close();

  const Session session = read_session(dir / "a.h5");
  ASSERT_GT(session.size(), 500u);
  EXPECT_GT(session.changes.size(), 20u);
  const RunPlan plan = replay(session, "a.h5", session_parameters(session, "a.h5"));
  EXPECT_EQ(test::first_difference(test::rows_of(session), test::rows_of(plan)), -1);
}

// Time of the newest row in ticks, after some more ticks of the loop.
std::int64_t arm_ticks(LiveLoop& loop) {
  let_live(loop, 20);
  loop.update();
  const double t = loop.layout().in(std::span<const double>(loop.snapshot().row), Column::time)[0];
  return std::llround(t * 1e3);
}

TEST(LiveLoop, StandsStillWhilePausedAndGoesOnByAsManyTicksAsAreAskedFor) {
  LiveLoop loop({});
  Controls controls;
  const SceneDocument table = test::omni_document("table.toml");
  loop.open(test::omni(), table.scene, controls.parameters(), kHome);
  let_live(loop, 50);
  controls.paused = true;
  loop.set(controls);
  const std::int64_t stood = arm_ticks(loop);
  EXPECT_EQ(arm_ticks(loop), stood);
  ++controls.steps;
  loop.set(controls);
  EXPECT_EQ(arm_ticks(loop), stood + 1);
  controls.steps += 7;
  loop.set(controls);
  EXPECT_EQ(arm_ticks(loop), stood + 8);
  loop.cut();  // a cut does not wait
  EXPECT_EQ(arm_ticks(loop), stood + 9);
  EXPECT_EQ(loop.snapshot().arming, Arming::off);
  controls.steps += 1000;  // the remaining steps are dropped
  controls.paused = false;
  controls.slow = 10;
  loop.set(controls);
  const std::int64_t before = arm_ticks(loop), began = loop.status().ticks;
  let_live(loop, 300);
  const std::int64_t went = arm_ticks(loop) - before, lived = loop.status().ticks - began;
  EXPECT_NEAR(static_cast<double>(went), static_cast<double>(lived) / 10, 3);
}

// A hand may hold the device.
TEST(LiveLoop, DoesNotStandStillForADevice) {
  LiveLoop loop({});
  Controls controls;
  const SceneDocument table = test::omni_document("table.toml");
  loop.open(test::omni(), table.scene, controls.parameters(),
            std::make_unique<test::FakeDevice>(3));
  controls.paused = true;
  controls.slow = 100;
  loop.set(controls);
  const std::int64_t before = arm_ticks(loop), began = loop.status().ticks;
  let_live(loop, 100);
  EXPECT_NEAR(static_cast<double>(arm_ticks(loop) - before),
              static_cast<double>(loop.status().ticks - began), 30);
}

// Number of page faults of the haptic thread; -1 if it is not found.
std::int64_t page_faults() {
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string stat;
    std::getline(std::ifstream(task.path() / "stat"), stat);
    const auto end = stat.find("(haptics) ");
    if (end == std::string::npos) continue;
    std::istringstream fields(stat.substr(end + 10));
    std::string state;
    std::int64_t skipped = 0, minor = 0, of_children = 0, major = 0;
    fields >> state;
    for (int i = 0; i < 6; ++i) fields >> skipped;
    fields >> minor >> of_children >> major;
    return minor + major;
  }
  return -1;
}

// Drops an object's code from memory, as if other programs had needed the memory for long.
int drop_code(dl_phdr_info* object, std::size_t, void*) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || segment.p_flags != (PF_R | PF_X)) continue;
    const std::uintptr_t from = (object->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t to = object->dlpi_addr + segment.p_vaddr + segment.p_memsz;
    madvise(reinterpret_cast<void*>(from), to - from, MADV_DONTNEED);
  }
  return 0;
}

// The leaf is a mesh, whose search tree must be in memory, too.
TEST(LiveLoop, MeetsNoPageFaultFromItsFirstTickOnWhateverItTouches) {
  const ArmDescription arm = test::omni();
  dl_iterate_phdr(drop_code, nullptr);
  SceneDocument leaf = test::omni_document("leaf.toml");
  build_meshes(leaf);
  LiveLoop loop({});
  if (kSanitized || !test::may_lock_memory()) {
    GTEST_SKIP() << "memory cannot be locked here";
  }
  ASSERT_TRUE(loop.status().realtime.memory_locked);
  const std::int64_t before = page_faults();
  ASSERT_GT(before, 0);
  Controls controls;
  loop.open(arm, leaf.scene, controls.parameters(), kHome);
  double contact = 0;
  controls.grab = true;
  for (const CouplingKind kind :
       {CouplingKind::predictive, CouplingKind::proposed, CouplingKind::standard}) {
    controls.parameters().kind = kind;
    for (int i = 0; i < 20; ++i) {
      controls.goal = kHome + Vec3(0.002 * (i % 10), 0.001 * i, -0.005 * i);
      loop.set(controls);
      let_live(loop, 20);
      loop.update();
      const std::span<const double> row(loop.snapshot().row);
      const auto f2 = loop.layout().in(row, Column::contact_torque);
      for (const double torque : f2) contact += std::abs(torque);
    }
  }
  EXPECT_GT(contact, 0);
  EXPECT_EQ(page_faults() - before, 0);
}

TEST(LiveLoop, RunsThreeLanesOnTheSameHandAndRecordsAll) {
  const test::TempDir dir;
  LiveLoop loop({});
  Controls controls;
  RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  controls.lane_count = kMostLanes;
  controls.lanes[kTwinLane].kind = CouplingKind::standard;
  controls.lanes[2].kind = CouplingKind::predictive;
  controls.grab = true;
  controls.goal = kHome + Vec3(0, 0.02, -0.05);
  loop.open(plan.arm, plan.document.scene, controls.parameters(), kHome);
  loop.set(controls);
  let_live(loop, 50);
  plan.parameters = controls.parameters();
  for (std::size_t i = 1; i < kMostLanes; ++i) plan.beside.push_back({controls.lanes[i], {}});
  loop.record(std::make_unique<Recorder>(dir / "a.h5", session_info(plan), plan.settings(), false));
  let_live(loop, 300);
  controls.lanes[kTwinLane].k_vc = 7;
  loop.set(controls);
  let_live(loop, 200);
  loop.finish_recording();
  loop.close();

  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.lanes(), kMostLanes);
  ASSERT_GE(session.size(), 400u);
  const std::size_t last = session.size() - 1;
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  std::vector<test::Rows> rows(kMostLanes, test::Rows(session.layout));
  const RunPlan again = replay(session, "a.h5", session_parameters(session, "a.h5"));
  simulate(again, {}, [&](std::span<const double> all, const auto&) {
    for (std::size_t i = 0; i < kMostLanes; ++i) rows[i].add(all.subspan(i * stride, stride));
    return true;
  });
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    const Session& lane = session.lane(i);
    ASSERT_EQ(lane.size(), session.size());
    EXPECT_EQ(lane.at(last, Column::kind)[0], static_cast<double>(controls.lanes[i].kind));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(session.at(last, Column::hand_target)[axis],
                lane.at(last, Column::hand_target)[axis]);
    }
    ASSERT_EQ(lane.changes.size(), i == kTwinLane ? 1u : 0u);
    EXPECT_EQ(test::first_difference(test::rows_of(lane), rows[i]), -1) << "comes again: " << i;
  }
  EXPECT_EQ(session.lane(kTwinLane).changes[0].key(), "coupling.k_vc");
}

TEST(LiveLoop, RecordsWhatTheTwinWasSetToWhileItsFileWasOpened) {
  const test::TempDir dir;
  LiveLoop loop({});
  Controls controls;
  RunPlan plan = test::plan("table.toml", "touch.csv", 1);
  controls.lane_count = 2;
  loop.open(plan.arm, plan.document.scene, controls.parameters(), kHome);
  loop.set(controls);
  let_live(loop, 50);
  plan.parameters = controls.parameters();
  plan.beside.push_back({controls.lanes[kTwinLane], {}});
  auto recorder =
      std::make_unique<Recorder>(dir / "a.h5", session_info(plan), plan.settings(), false);
  controls.lanes[kTwinLane].k_vc = 7;
  loop.set(controls);
  let_live(loop, 50);
  loop.record(std::move(recorder));
  let_live(loop, 100);
  loop.finish_recording();
  loop.close();
  const Session session = read_session(dir / "a.h5");
  ASSERT_EQ(session.lanes(), 2u);
  ASSERT_EQ(session.lane(kTwinLane).changes.size(), 1u);
  EXPECT_EQ(session.lane(kTwinLane).changes[0].row, 0u);
  EXPECT_EQ(session.lane(kTwinLane).changes[0].key(), "coupling.k_vc");
}

TEST(LiveLoop, ShowsTheNewestRowAndHandsOverEveryOne) {
  LiveLoop loop({});
  Controls controls;
  loop.open(test::omni(), test::omni_scene("table.toml"), controls.parameters(), kHome);
  loop.set(controls);
  let_live(loop, 200);
  loop.close();
  const RowLayout layout(3);
  const auto stride = static_cast<std::size_t>(layout.stride());
  std::vector<double> rows(10000 * kMostLanes * stride);
  const std::size_t count = loop.drain(rows);
  ASSERT_GE(count, 200u);
  EXPECT_EQ(loop.trace_dropped(), 0u);
  for (std::size_t k = 0; k < count; ++k) {
    const auto both =
        std::span<const double>(rows).subspan(k * kMostLanes * stride, kMostLanes * stride);
    ASSERT_NEAR(layout.in(both.first(stride), Column::time)[0], static_cast<double>(k) * 1e-3,
                1e-9);
    ASSERT_TRUE(std::isnan(both[stride]) && std::isnan(both[2 * stride]));  // one lane
  }
  EXPECT_TRUE(loop.update());
  EXPECT_NEAR(layout.in(std::span<const double>(loop.snapshot().row), Column::time)[0],
              static_cast<double>(count - 1) * 1e-3, 1e-9);
  EXPECT_FALSE(loop.update());
}

TEST(LiveLoop, StartsOverWhenAsked) {
  LiveLoop loop({});
  Controls controls;
  loop.open(test::omni(), Scene{}, controls.parameters(), kHome);
  controls.grab = true;
  controls.goal = kHome + Vec3(0, 0.05, 0);
  loop.set(controls);
  let_live(loop, 300);
  controls.grab = false;
  controls.resets = 1;
  loop.set(controls);
  let_live(loop, 5);
  loop.close();
  ASSERT_TRUE(loop.update());
  const RowLayout layout(3);
  const auto row = std::span<const double>(loop.snapshot().row);
  const auto start = rest_at(test::omni(), kHome).x1;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(layout.in(row, Column::device_position)[i], start[static_cast<int>(i)], 1e-4);
  }
}

TEST(LiveLoop, RefusesAHomeOutOfReachAndGoesOnAsBefore) {
  LiveLoop loop({});
  loop.open(test::omni(), Scene{}, Parameters{}, kHome);
  EXPECT_THROW(loop.open(test::omni(), Scene{}, Parameters{}, Vec3(3, 0, 0)),
               std::invalid_argument);
  EXPECT_TRUE(loop.status().running);
  let_live(loop, 10);
}

TEST(LiveLoop, KeepsTheForceOfTheVirtualArmInAnotherScene) {
  LiveLoop loop({});
  const auto open = [&] { loop.open(test::omni(), Scene{}, Parameters{}, kHome); };
  const auto armed = [&] {
    let_live(loop, 10);
    loop.update();
    return loop.snapshot().arming != Arming::off;
  };
  open();
  EXPECT_TRUE(armed());
  loop.cut();
  EXPECT_FALSE(armed());
  open();
  EXPECT_FALSE(armed());
  loop.arm();
  EXPECT_TRUE(armed());
  open();
  EXPECT_TRUE(armed());
}

TEST(LiveLoop, KeepsTheForceOfTheVirtualArmWhileARealDeviceTakesItsPlace) {
  LiveLoop loop({});
  loop.open(test::omni(), Scene{}, Parameters{}, kHome);
  loop.open(test::omni(), Scene{}, Parameters{}, std::make_unique<test::FakeDevice>(3));
  let_live(loop, 10);
  loop.update();
  EXPECT_EQ(loop.snapshot().arming, Arming::off);
  loop.open(test::omni(), Scene{}, Parameters{}, kHome);
  let_live(loop, 10);
  loop.update();
  EXPECT_EQ(loop.snapshot().arming, Arming::on);
}

// A new start does not arm force that an instability has switched off.
TEST(LiveLoop, StaysOffWhenItStartsOverAfterAnInstability) {
  LiveLoop loop({});
  Controls controls;
  loop.open(test::omni(), Scene{}, controls.parameters(), kHome);
  let_live(loop, 5);
  controls.parameters().k_vc = std::numeric_limits<double>::infinity();
  loop.set(controls);
  do {
    let_live(loop, 1);
    loop.update();
  } while (!loop.snapshot().diverged);
  controls.parameters() = {};
  controls.resets = 1;
  loop.set(controls);
  let_live(loop, 20);
  loop.update();
  EXPECT_FALSE(loop.snapshot().diverged);
  EXPECT_EQ(loop.snapshot().arming, Arming::off);
}

// Closing a device may take long; it must not push meanwhile.
TEST(LiveLoop, StopsADeviceThatIsReplaced) {
  std::vector<bool> stopped;
  LiveLoop loop({}, [&](std::unique_ptr<Device> device) {
    stopped.push_back(static_cast<test::FakeDevice&>(*device).stopped);
  });
  loop.open(test::omni(), Scene{}, Parameters{}, std::make_unique<test::FakeDevice>(3));
  let_live(loop, 10);
  loop.plug(std::make_unique<test::FakeDevice>(3));
  while (stopped.empty()) {
    let_live(loop, 1);
    loop.update();
  }
  EXPECT_TRUE(stopped[0]);
}

TEST(LiveLoop, TakesAPressAfterATripForNone) {
  const auto wire = std::make_shared<test::Wire>();
  LiveLoop loop({});
  loop.open(test::omni(), Scene{}, Parameters{}, std::make_unique<test::WiredDevice>(3, wire));
  const auto frame = [&] {
    loop.set({});
    let_live(loop, 2);
    loop.update();
    return loop.snapshot().arming;
  };
  const auto becomes = [&](Arming wanted) {
    return test::until([&] { return frame() == wanted; }, [] {});
  };
  for (int i = 0; i < 20; ++i) EXPECT_EQ(frame(), Arming::off);
  EXPECT_TRUE(loop.toggle_force());
  ASSERT_TRUE(becomes(Arming::on));
  wire->here = false;
  ASSERT_TRUE(becomes(Arming::tripped));
  wire->here = true;
  const auto tripped = std::chrono::steady_clock::now();
  EXPECT_FALSE(loop.toggle_force());
  while (std::chrono::steady_clock::now() - tripped < 1100ms) {
    EXPECT_EQ(frame(), Arming::tripped);
  }
  EXPECT_TRUE(loop.toggle_force());
  EXPECT_TRUE(becomes(Arming::on));
}

TEST(LiveLoop, StopsItsDeviceBeforeItHandsItOver) {
  std::vector<bool> stopped;
  LiveLoop loop({}, [&](std::unique_ptr<Device> device) {
    stopped.push_back(static_cast<test::FakeDevice&>(*device).stopped);
  });
  loop.open(test::omni(), Scene{}, Parameters{}, std::make_unique<test::FakeDevice>(3));
  let_live(loop, 10);
  loop.close();
  EXPECT_EQ(stopped, std::vector{true});
}

// A device that answers from the middle of its ranges, except 0.9 rad at the first joint.
class Turned final : public Device {
 public:
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    newest.x = {0.9, -0.785, 1.57};
    newest.count = ++count_;
    return true;
  }
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  DeviceTraits traits_ = test::pushing(3);
  std::uint64_t count_ = 0;
};

TEST(LiveLoop, HoldsADeviceThatIsOpenedAgainToItsLowerLimits) {
  LiveLoop loop({});
  Controls controls;
  controls.limits.range = 0.5;  // narrower than the arm's 1 rad; 0.1 more until force is gone
  loop.set(controls);
  for (int opened = 0; opened < 2; ++opened) {
    loop.open(test::omni(), Scene{}, Parameters{}, std::make_unique<Turned>());
    let_live(loop, 5);
    loop.arm();
    let_live(loop, 50);
    loop.update();
    EXPECT_EQ(loop.snapshot().force_state, ForceState::too_far);
  }
}

// A device held inside a stop of its first joint; its motors warm up within milliseconds and cool
// within a minute.
TEST(LiveLoop, KnowsThatTheMotorsOfADeviceThatComesBackAreStillWarm) {
  ArmDescription arm = test::omni();
  for (Joint& joint : arm.joints) {
    joint.continuous = 1e-3 * joint.effort;
    joint.warming = 60;
  }
  Scene scene;
  scene.add({.name = "stop", .shape = JointStop{0, 0.85, 1}, .material = {200}});
  LiveLoop loop({});
  const auto open = [&] {
    loop.open(arm, scene, Parameters{}, std::make_unique<Turned>());
    let_live(loop, 3);
    loop.update();
    return RowLayout(3).in(std::span<const double>(loop.snapshot().row), Column::motor_warmth)[0];
  };
  EXPECT_EQ(open(), 0);
  loop.warmth_memory()->add(Eigen::Vector3d(0.2, 0, 0), in_seconds(MonotonicTime{}.now()));
  EXPECT_NEAR(open(), 0.2, 0.02) << "warmed up beside the loop";
  loop.arm();
  let_live(loop, 200);
  loop.update();
  const double warm =
      RowLayout(3).in(std::span<const double>(loop.snapshot().row), Column::motor_warmth)[0];
  ASSERT_GT(warm, 0.4);
  EXPECT_GT(open(), 0.9 * warm);
  loop.open(arm, scene, Parameters{}, kHome);  // the virtual arm's are cold
  let_live(loop, 3);
  loop.update();
  EXPECT_EQ(RowLayout(3).in(std::span<const double>(loop.snapshot().row), Column::motor_warmth)[0],
            0);
  EXPECT_GT(open(), 0.8 * warm);
}

TEST(WarmthMemory, CoolsAndIsKeptByTheNumberOfJoints) {
  ArmDescription arm = test::omni();
  arm.joints[1].continuous = 0.1;
  arm.joints[1].warming = 60;
  WarmthMemory memory;
  EXPECT_EQ(memory.take(arm, 5), Eigen::VectorXd(Eigen::Vector3d::Zero()));
  memory.keep(Eigen::Vector3d(0, 0.8, 0.3), 5);
  memory.keep(Eigen::Vector2d(1, 1), 6);
  const Eigen::VectorXd left = memory.take(arm, 65);
  ASSERT_EQ(left.size(), 3);
  EXPECT_NEAR(left[1], 0.8 * std::exp(-1), 1e-12);
  EXPECT_EQ(left[2], 0) << "this arm has no model of the motor";
}

TEST(WarmthMemory, AddsWhatAMotionBesideTheLoopsWarmedUp) {
  ArmDescription arm = test::omni();
  arm.joints[1].continuous = 0.1;
  arm.joints[1].warming = 60;
  WarmthMemory memory;
  memory.keep(Eigen::Vector3d(0, 0.4, 0), 0);
  memory.add(Eigen::Vector3d(0, 0, 0), 0);
  EXPECT_FALSE(memory.added(3)) << "nothing was warmed up";
  memory.add(Eigen::Vector3d(0, 0.3, 0), 30);
  memory.add(Eigen::Vector3d(0, 0.1, 0), 30);
  memory.keep(Eigen::Vector3d(0, 0.4 * std::exp(-0.5), 0), 30);  // a loop that ends forgets none
  EXPECT_TRUE(memory.added(3));
  EXPECT_NEAR(memory.take(arm, 60)[1], 0.4 * std::exp(-1) + 0.4 * std::exp(-0.5), 1e-12);
  EXPECT_FALSE(memory.added(3));
  EXPECT_NEAR(memory.take(arm, 60)[1], 0.4 * std::exp(-1) + 0.4 * std::exp(-0.5), 1e-12);
}

// A SpaceMouse that moves the hand of the virtual arm.
class Cap final : public Device {
 public:
  explicit Cap(std::shared_ptr<std::atomic<double>> push) : push_(std::move(push)) {
    traits_.dof = 6;
  }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    newest.x[0] = *push_;  // push to the right
    newest.count = ++count_;
    return true;
  }
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  DeviceTraits traits_;
  std::shared_ptr<std::atomic<double>> push_;
  std::uint64_t count_ = 0;
};

struct LedLoop : testing::Test {
  LedLoop() {
    loop.open(test::omni(), Scene{}, controls.parameters(), kHome);
    loop.plug(std::make_unique<Cap>(push));
  }
  void live(int ticks) {
    loop.set(controls);
    let_live(loop, ticks);
    loop.update();
  }
  // Largest deviation of a joint from the arm's rest [rad].
  double away() const {
    const auto row = std::span<const double>(loop.snapshot().row);
    const auto x = RowLayout(3).in(row, Column::device_position);
    return (Eigen::Map<const Eigen::Vector3d>(x.data()) - rest_at(test::omni(), kHome).x1)
        .cwiseAbs()
        .maxCoeff();
  }
  Controls controls;
  std::shared_ptr<std::atomic<double>> push = std::make_shared<std::atomic<double>>(0);
  LiveLoop loop{{}};
};

// The mouse wanted the tip 3 cm away, with a hand too weak to move it.
TEST_F(LedLoop, IsTakenHoldOfWhereTheTipIs) {
  controls.grab = true;
  controls.goal = kHome + Vec3(0, 0.03, 0);
  controls.parameters().hand_stiffness = 1e-3;
  live(100);
  controls.grab = false;
  live(100);
  const double before = away();
  controls.parameters() = {};
  *push = 0.07;  // a very weak push
  live(500);
  EXPECT_NEAR(away(), before, 0.02);
}

TEST_F(LedLoop, RestsWhenItIsStartedOver) {
  *push = 1;
  live(300);
  ASSERT_GT(away(), 0.1);
  *push = 0;
  live(20);
  controls.resets = 1;
  live(300);
  EXPECT_LT(away(), 0.001);
}

TEST(LiveLoop, ForgetsWhatWasAskedBeforeItWasOpened) {
  LiveLoop loop({});
  auto device = std::make_unique<test::FakeDevice>(3);
  loop.arm();
  loop.open(test::omni(), Scene{}, Parameters{}, std::move(device));
  loop.arm();
  loop.cut();
  let_live(loop, 20);
  loop.update();
  EXPECT_EQ(loop.snapshot().arming, Arming::off);
}

// Device and proxy begin at the device's first reading, if it is possible.
TEST(LiveLoop, DoesNotBeginWhereItsDeviceCannotBe) {
  LiveLoop loop({});
  for (const double first : {1e6, std::nan("")}) {
    auto device = std::make_unique<test::FakeDevice>(3);
    device->reading.x[1] = first;
    loop.open(test::omni(), Scene{}, Parameters{}, std::move(device));
    let_live(loop, 20);
    loop.update();
    EXPECT_EQ(loop.snapshot().force_state, ForceState::wrong);
    const RowLayout layout(3);
    const std::span<const double> row(loop.snapshot().row);
    for (const Column at : {Column::device_position, Column::proxy_position}) {
      for (const double x : layout.in(row, at)) EXPECT_LT(std::abs(x), 4);
    }
  }
}

TEST(LiveLoop, TakesItsForceAwayWhenNobodySetsItsControls) {
  LiveLoop loop({});
  auto device = std::make_unique<test::FakeDevice>(3);
  Eigen::Map<Eigen::Vector3d>(device->reading.x.data()) = rest_pose(test::omni());
  loop.open(test::omni(), Scene{}, Parameters{}, std::move(device));
  const auto state = [&] {
    loop.update();
    return loop.snapshot().arming;
  };
  ASSERT_TRUE(test::until([&] { return state() == Arming::on; },
                          [&] {
                            const Arming now = state();
                            if (now == Arming::off || now == Arming::tripped) loop.arm();
                            loop.set({});
                            std::this_thread::sleep_for(5ms);
                          }));
  ASSERT_TRUE(test::until([&] { return state() == Arming::tripped; }));
  EXPECT_EQ(loop.snapshot().force_state, ForceState::unwatched);
}

// A recorder is offered, taken and given up in every order, again and again.
TEST(LiveLoop, LosesNoRecorderHoweverSoonItIsStopped) {
  const test::TempDir dir;
  const ArmDescription arm = test::omni();
  LiveLoop loop({});
  loop.open(arm, Scene{}, Parameters{}, kHome);
  for (int i = 0; i < 40; ++i) {
    const auto file = dir / ("a" + std::to_string(i) + ".h5").c_str();
    loop.record(recorder(file, arm, {}, Parameters{}));
    if (i % 4 != 0) std::this_thread::sleep_for(std::chrono::microseconds(300 * (i % 7)));
    if (i % 5 == 4) {
      loop.open(arm, Scene{}, Parameters{}, kHome);  // while it is recording
    }
    loop.finish_recording();
    EXPECT_FALSE(loop.recording());
    EXPECT_TRUE(std::filesystem::exists(file)) << i;
  }
}

TEST(LiveLoop, TakesNoRecorderOfAnotherWidth) {
  const test::TempDir dir;
  LiveLoop loop({});
  loop.open(test::omni(), Scene{}, Parameters{}, kHome);
  EXPECT_THROW(loop.record(recorder(dir / "a.h5", test::random_arm(2, 3), {}, Parameters{})),
               std::invalid_argument);
  EXPECT_FALSE(loop.recording());
  let_live(loop, 20);
}

}  // namespace
}  // namespace limpid
