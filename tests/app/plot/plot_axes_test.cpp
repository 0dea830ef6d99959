// Axes over time: autoscale, the window shared by the plots, and files written beside one another.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "app/plot/axis.h"
#include "app/plot/plot.h"
#include "app/plot/plot_menu.h"
#include "render/gl/offscreen.h"

namespace limpid {
namespace {

constexpr double kFrame = 1.0 / 60;

TEST(Autoscale, NeverCutsDataOff) {
  Autoscale autoscale;
  for (int i = 0; i < 500; ++i) {
    const double size = 1 + 100 * std::abs(std::sin(0.3 * i));
    const Limits shown = autoscale.update({-size, 2 * size}, 1e-3, kFrame);
    EXPECT_LE(shown.low, -size);
    EXPECT_GE(shown.high, 2 * size);
  }
}

TEST(Autoscale, StandsStillWhileTheDataOnlyBreathes) {
  Autoscale autoscale;
  const Limits first = autoscale.update({-1, 1}, 1e-3, kFrame);
  for (int i = 0; i < 600; ++i) {
    const double size = 0.9 + 0.1 * std::sin(0.1 * i);
    EXPECT_EQ(autoscale.update({-size, size}, 1e-3, kFrame), first);
  }
}

TEST(Autoscale, ShrinksAfterAWhileAndSettles) {
  Autoscale autoscale;
  const Limits wide = autoscale.update({-100, 100}, 1e-3, kFrame);
  EXPECT_EQ(autoscale.update({-1, 1}, 1e-3, kFrame), wide) << "not at once";
  Limits shown;
  for (int i = 0; i < 300; ++i) shown = autoscale.update({-1, 1}, 1e-3, kFrame);
  EXPECT_LT(shown.span(), 3);
  EXPECT_EQ(autoscale.update({-1, 1}, 1e-3, kFrame), shown);
}

TEST(Autoscale, ShowsAtLeastTheSmallestSpan) {
  Autoscale autoscale;
  EXPECT_GE(autoscale.update({0, 0}, 0.5, kFrame).span(), 0.5);
}

TEST(Autoscale, BeginsAMagnitudesAxisAtZero) {
  Autoscale autoscale;
  EXPECT_EQ(autoscale.update({0, 0.0015}, 0.02, kFrame).low, 0);
  const Limits grown = autoscale.update({0, 0.4}, 0.02, kFrame);
  EXPECT_EQ(grown.low, 0);
  EXPECT_GE(grown.high, 0.4);
  EXPECT_LE(autoscale.update({-0.1, 0.4}, 0.02, kFrame).low, -0.1) << "what is signed has both";
}

TEST(Autoscale, ShowsALittleAsALittle) {
  Autoscale autoscale;
  EXPECT_GE(autoscale.update({0, 0.0015}, 0.02, kFrame).high, 0.02);
}

History seconds_of_data(double seconds) {
  History history({.seconds = 120});
  for (int i = 0; i <= static_cast<int>(seconds * 1000); ++i) {
    history.append(i * 0.001, std::array{0.0});
  }
  return history;
}

TEST(PlotGroup, FollowsTheNewestDataOnceTheWindowIsFull) {
  PlotGroup group(10);
  group.begin_frame(seconds_of_data(4));
  EXPECT_DOUBLE_EQ(group.start(), 0);
  EXPECT_DOUBLE_EQ(group.stop(), 10);
  group.begin_frame(seconds_of_data(30));
  EXPECT_DOUBLE_EQ(group.stop(), 30);
}

TEST(PlotGroup, PanningBackStopsFollowingAndForwardResumes) {
  const History history = seconds_of_data(30);
  PlotGroup group(10);
  group.begin_frame(history);
  group.pan(-5);
  EXPECT_FALSE(group.following());
  group.begin_frame(history);
  EXPECT_DOUBLE_EQ(group.stop(), 25);
  group.pan(6);
  EXPECT_TRUE(group.following());
  group.begin_frame(history);
  EXPECT_DOUBLE_EQ(group.stop(), 30);
}

TEST(PlotGroup, ZoomKeepsTheTimeUnderTheMouse) {
  const History history = seconds_of_data(30);
  PlotGroup group(10);
  group.begin_frame(history);
  group.pan(-5);
  const double around = 18;
  const double before = (around - group.start()) / group.length();
  group.zoom(0.5, around);
  EXPECT_NEAR((around - group.start()) / group.length(), before, 1e-12);
  EXPECT_DOUBLE_EQ(group.length(), 5);
}

TEST(PlotGroup, SomeDataStaysInViewHoweverFarOnePans) {
  const History history = seconds_of_data(30);
  PlotGroup group(10);
  group.begin_frame(history);
  for (const double far : {-1000.0, 2000.0}) {
    group.set_following(false);
    group.pan(far);
    group.begin_frame(history);
    EXPECT_LT(group.start(), 30);
    EXPECT_GT(group.stop(), 0);
  }
}

TEST(PlotGroup, KeepsPlaybackInViewWhenZoomedIn) {
  const History history = seconds_of_data(30);
  PlotGroup group(30);
  group.begin_frame(history, 0.0);
  group.zoom(0.1, 0);
  for (const double playback : {0.0, 4.0, 17.0, 30.0}) {
    group.begin_frame(history, playback);
    EXPECT_LE(group.start(), playback);
    EXPECT_GE(group.stop(), playback);
  }
}

TEST(PlotMenu, NeverOverwritesAFile) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "limpid-free-file" / "deep";
  std::filesystem::remove_all(folder);
  EXPECT_EQ(free_file(folder, "energy", "csv"), folder / "energy-001.csv");
  std::ofstream(folder / "energy-001.csv") << "x";
  EXPECT_EQ(free_file(folder, "energy", "csv"), folder / "energy-002.csv");
}

TEST(PlotMenu, SaysWhichFolderCannotBeMadeAndWhy) {
  try {
    free_file("/dev/null/plots", "energy", "csv");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/dev/null/plots"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("Not a directory"), std::string::npos) << e.what();
  }
}

TEST(Picture, FullDiskIsToldOf) {
  try {
    write_png("/dev/full", 2, 2, std::vector<unsigned char>(16, 255));
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("No space left on device"), std::string::npos) << e.what();
  }
}

TEST(PlotMenu, TellsWhatWasSavedOrWhyNot) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "limpid-fulfil";
  std::filesystem::remove_all(folder);
  const PlotSpec spec{.file_name = "energy", .y = {.unit = "J"}, .curves = {{.label = "E"}}};
  const History history = seconds_of_data(1);
  PlotSaving saving;
  saving.folder = folder;
  const auto good = fulfil(PlotWish::save_csv, spec, history, {0, 1, {}, {{-1, 1}}}, saving);
  ASSERT_TRUE(good);
  EXPECT_FALSE(good->bad);
  EXPECT_TRUE(std::filesystem::exists(folder / "energy-001.csv"));
  EXPECT_NE(good->text.find("energy-001.csv"), std::string::npos);
  saving.folder = "/dev/null/x";
  const auto bad = fulfil(PlotWish::save_svg, spec, history, {0, 1, {}, {{-1, 1}}}, saving);
  ASSERT_TRUE(bad);
  EXPECT_TRUE(bad->bad);
}

// The window writes on another thread, and the history goes on meanwhile.
TEST(PlotMenu, WritesATableElsewhereAsItWasWhenAskedFor) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "limpid-beside";
  std::filesystem::remove_all(folder);
  const PlotSpec spec{.file_name = "energy", .y = {.unit = "J"}, .curves = {{.label = "E"}}};
  std::function<PlotNotice()> work;
  PlotSaving saving;
  saving.folder = folder;
  saving.beside = [&](std::function<PlotNotice()> w) { work = std::move(w); };
  {
    History history({.channels = 1, .seconds = 1});
    history.append(0, std::array{0.25});
    history.append(0.001, std::array{0.5});
    EXPECT_FALSE(fulfil(PlotWish::save_csv, spec, history, {0, 1, {}, {{-1, 1}}}, saving));
    history.append(0.002, std::array{0.75});
  }
  EXPECT_FALSE(std::filesystem::exists(folder)) << "nothing is written before";
  ASSERT_TRUE(work);
  EXPECT_FALSE(work().bad);
  std::ifstream file(folder / "energy-001.csv");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            "time [s],E [J]\n0.000000,0.25\n0.001000,0.5\n");
}

}  // namespace
}  // namespace limpid
