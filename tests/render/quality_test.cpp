#include "render/quality.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace limpid {
namespace {

// Feeds frames for `seconds`, each as long as its level takes; returns the number of changes.
int play(AutoQuality& quality, double seconds, const std::function<double(int level)>& frame) {
  int changes = 0;
  for (double t = 0; t < seconds;) {
    const double taken = frame(quality.level());
    changes += quality.frame(taken);
    t += taken;
  }
  return changes;
}

TEST(Quality, IsLowerWhereAProcessorDraws) {
  const Quality software = Quality::automatic("llvmpipe (LLVM 15.0.6, 256 bits)");
  const Quality hardware = Quality::automatic("NVIDIA GeForce RTX 3060/PCIe/SSE2");
  EXPECT_EQ(software.msaa, 1);
  EXPECT_EQ(hardware.msaa, 4);
  EXPECT_LT(software.shadow_size, hardware.shadow_size);
}

TEST(Quality, FallsFromLevelToLevel) {
  for (int level = 1; level <= Quality::kLowest; ++level) {
    const Quality better = Quality::level(level - 1), worse = Quality::level(level);
    EXPECT_LE(worse.msaa, better.msaa);
    EXPECT_LE(worse.shadow_size, better.shadow_size);
    EXPECT_LE(worse.scale, better.scale);
    EXPECT_LE(worse.triangles, better.triangles);
  }
  EXPECT_EQ(Quality::level(-3).msaa, Quality::level(0).msaa);
  EXPECT_EQ(Quality::level(99).scale, Quality::level(Quality::kLowest).scale);
}

TEST(AutoQuality, StepsDownAfterASecondOfSlowFrames) {
  AutoQuality quality(0);
  EXPECT_EQ(play(quality, 0.9, [](int) { return 0.030; }), 0);
  EXPECT_EQ(play(quality, 0.2, [](int) { return 0.030; }), 1);
  EXPECT_EQ(quality.level(), 1);
}

TEST(AutoQuality, GoesDownUntilItIsFastEnoughAndStays) {
  AutoQuality quality(0);
  const auto frame = [](int level) { return level < 3 ? 0.060 : 0.020; };
  EXPECT_EQ(play(quality, 60, frame), 3);
  EXPECT_EQ(quality.level(), 3);
}

TEST(AutoQuality, EndsAtTheLowestLevelHoweverSlow) {
  AutoQuality quality(0);
  play(quality, 100, [](int) { return 2.0; });
  EXPECT_EQ(quality.level(), Quality::kLowest);
}

TEST(AutoQuality, OverlooksSingleLongFrames) {
  AutoQuality quality(0);
  int count = 0;
  EXPECT_EQ(play(quality, 60, [&](int) { return ++count % 20 == 0 ? 0.5 : 0.016; }), 0);
}

TEST(AutoQuality, ClimbsAfterSeveralFastSeconds) {
  AutoQuality quality(3);
  EXPECT_EQ(play(quality, 3, [](int) { return 0.010; }), 0);
  play(quality, 30, [](int) { return 0.010; });
  EXPECT_EQ(quality.level(), 0);
}

TEST(AutoQuality, TakesTheFramesOfASixtyHertzScreenAsFast) {
  AutoQuality quality(1);
  play(quality, 20, [](int) { return 1.0 / 60; });
  EXPECT_EQ(quality.level(), 0);
}

TEST(AutoQuality, LeavesWhatIsNeitherFastNorSlow) {
  AutoQuality quality(2);
  EXPECT_EQ(play(quality, 600, [](int) { return 0.021; }), 0);
}

// A level is fast and the next one too slow: it may try again, but ever more rarely.
TEST(AutoQuality, SettlesBetweenTwoLevels) {
  AutoQuality quality(2);
  const auto frame = [](int level) { return level < 2 ? 0.040 : 0.008; };
  const int early = play(quality, 300, frame);
  const int late = play(quality, 300, frame);
  EXPECT_LE(early, 14);
  EXPECT_LE(late, 2);
  quality.reset();
  EXPECT_GE(play(quality, 10, frame), 1);
}

TEST(AutoQuality, IgnoresTimesThatAreNone) {
  AutoQuality quality(1);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(quality.frame(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(quality.frame(-1));
  }
}

// Each level waits anew for as many good seconds as the first one, and so does one after a reset.
TEST(AutoQuality, WaitsAsLongForEachStepUp) {
  const auto seconds_to_change = [](AutoQuality& quality) {
    int frames = 0;
    do {
      ++frames;
    } while (!quality.frame(0.010));
    return frames * 0.010;
  };
  AutoQuality quality(3);
  const double first = seconds_to_change(quality);
  EXPECT_NEAR(seconds_to_change(quality), first, 0.05);
  EXPECT_NEAR(seconds_to_change(quality), first, 0.05);
  AutoQuality other(3);
  EXPECT_EQ(play(other, first - 0.5, [](int) { return 0.010; }), 0);
  other.reset();
  EXPECT_NEAR(seconds_to_change(other), first, 0.05);
  AutoQuality broken(3);
  EXPECT_EQ(play(broken, first - 0.5, [](int) { return 0.010; }), 0);
  EXPECT_EQ(play(broken, 1.2, [](int) { return 0.021; }), 0) << "not fast for a second";
  EXPECT_GE(seconds_to_change(broken), first - 0.3);
}

}  // namespace
}  // namespace limpid
