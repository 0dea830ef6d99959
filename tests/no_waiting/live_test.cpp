// The live loop without allocations and locks: a guide, which the loop reads at every tick, watches
// the loop's thread.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "app/live/live_loop.h"
#include "app/run/replay.h"
#include "tests/no_waiting/watch.h"
#include "tests/support/device_traits.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
const Vec3 kHome(0.19, 0, 0);

struct Counts {
  std::atomic<int> allocations{0}, locks{0}, reads{0};
};

class WatchingGuide final : public Device {
 public:
  explicit WatchingGuide(Counts& counts) : counts_(counts) {
    traits_.dof = 6;
    traits_.name = "guide";
  }
  const DeviceTraits& traits() const override { return traits_; }
  bool read(DeviceReading& newest) noexcept override {
    watched.on = true;
    counts_.allocations = watched.allocations;
    counts_.locks = watched.locks;
    newest.count = static_cast<std::uint64_t>(++counts_.reads);
    return true;
  }
  void write(std::span<const double>) noexcept override {}
  void stop() noexcept override {}

 private:
  Counts& counts_;
  DeviceTraits traits_;
};

void let_live(LiveLoop& loop, std::int64_t ticks) {
  const auto until = loop.status().ticks + ticks;
  while (loop.status().ticks < until && loop.status().running) std::this_thread::sleep_for(1ms);
  ASSERT_TRUE(loop.status().running) << loop.status().failure;
}

TEST(NoWaitingLive, NeitherAllocatesNorLocksWhateverTheWindowAsksFor) {
  const test::TempDir dir;
  Counts counts;
  LiveLoop loop({});
  Controls controls;
  RunPlan plan = test::plan("pucks.toml", "touch.csv", 1);
  loop.open(plan.arm, plan.document.scene, controls.parameters(), kHome);
  loop.plug(std::make_unique<WatchingGuide>(counts));
  controls.grab = true;
  std::vector<double> rows(1024 * kMostLanes * static_cast<std::size_t>(loop.layout().stride()));
  const auto go_on = [&](std::int64_t ticks) {
    loop.set(controls);
    let_live(loop, ticks);
    loop.update();
    loop.drain(rows);
  };
  go_on(30);
  const int before = counts.reads;
  for (const std::size_t lanes : {3, 2, 1, 3}) {
    controls.lane_count = lanes;
    for (std::uint8_t kind = 0; kind < kLaws; ++kind) {
      for (std::size_t i = 0; i < kMostLanes; ++i) {
        controls.lanes[i].kind = static_cast<CouplingKind>((kind + i) % kLaws);
        controls.lanes[i].eta = 0.6 + 0.1 * kind;
      }
      controls.goal = kHome + Vec3(0, 0.01 * kind, -0.02 * kind);
      controls.magnet = kind % 2 == 0;
      go_on(20);
    }
    ++controls.resets;
    go_on(10);
    loop.exchange(std::make_unique<TouchWorlds>(plan.arm, plan.document.scene));
    go_on(10);
    loop.cut();
    go_on(10);
    loop.arm();
    go_on(10);
  }
  for (std::size_t i = 1; i < kMostLanes; ++i) plan.beside.push_back({controls.lanes[i], {}});
  plan.parameters = controls.parameters();
  loop.record(std::make_unique<Recorder>(dir / "a.h5", session_info(plan), plan.settings(), false));
  go_on(50);
  controls.lanes[2].eta = 0.9;
  controls.parameters().k_vc = 8;
  go_on(50);
  loop.finish_recording();
  go_on(30);
  EXPECT_GT(counts.reads, before + 300) << "the loop reads its guide";
  EXPECT_EQ(counts.allocations, 0);
  EXPECT_EQ(counts.locks, 0);
}

}  // namespace
}  // namespace limpid
