#include "app/desktop/playback/player.h"

#include <gtest/gtest.h>

#include "tests/devices/files/session/sample_session.h"

namespace limpid {
namespace {

Player player(std::size_t rows) {
  Session session;
  session.info = test::sample_info(3);
  const std::vector<double> sample = test::sample_rows(session.layout, 0, rows);
  session.rows.assign(sample.begin(), sample.end());
  return Player(std::make_shared<const Session>(std::move(session)));
}

TEST(Player, ShowsTheRowOfItsTime) {
  Player p = player(1000);
  EXPECT_NEAR(p.duration(), 1, 1e-12);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{537}, std::size_t{999}}) {
    p.seek(static_cast<double>(k) * 1e-3);
    EXPECT_EQ(p.index(), k);
    EXPECT_EQ(p.row_time(), static_cast<double>(k) * 1e-3);
    p.seek(static_cast<double>(k) * 1e-3 + 0.9e-3);  // between two rows, as during play
    EXPECT_EQ(p.index(), std::min<std::size_t>(k, 999));
    EXPECT_EQ(p.row_time(), static_cast<double>(k) * 1e-3);
    EXPECT_EQ(p.session().layout.in(p.row(), Column::time)[0], p.session().at(k, Column::time)[0]);
  }
}

TEST(Player, StaysInsideTheSessionWhereverItIsSent) {
  Player p = player(100);
  p.seek(-5);
  EXPECT_EQ(p.index(), 0u);
  p.seek(1e9);
  EXPECT_EQ(p.index(), 99u);
  p.step(1);
  EXPECT_EQ(p.index(), 99u);
  p.step(-1);
  EXPECT_EQ(p.index(), 98u);
}

TEST(Player, StepsThroughEveryRow) {
  Player p = player(500);
  p.play();
  for (std::size_t k = 1; k < 500; ++k) {
    p.step(1);
    ASSERT_EQ(p.index(), k);
  }
  EXPECT_FALSE(p.playing());
  for (std::size_t k = 499; k-- > 0;) {
    p.step(-1);
    ASSERT_EQ(p.index(), k);
  }
}

TEST(Player, AdvancesAtItsSpeedOnlyWhilePlaying) {
  Player p = player(10000);
  p.advance(1);
  EXPECT_EQ(p.time(), 0);
  p.play();
  p.speed = 2.5;
  for (int frame = 0; frame < 60; ++frame) p.advance(1.0 / 60);
  EXPECT_NEAR(p.time(), 2.5, 1e-9);
  p.pause();
  p.advance(1);
  EXPECT_NEAR(p.time(), 2.5, 1e-9);
}

TEST(Player, StopsAtTheEndAndBeginsAnewWhenPlayedAgain) {
  Player p = player(100);
  p.play();
  p.advance(0.35);
  EXPECT_FALSE(p.playing());
  EXPECT_EQ(p.index(), 99u);
  p.play();
  EXPECT_EQ(p.index(), 0u);
  EXPECT_TRUE(p.playing());
}

TEST(Player, GoesRoundWhenLooped) {
  Player p = player(100);
  p.loop = true;
  p.play();
  p.advance(0.0975);
  p.advance(0.01);
  EXPECT_TRUE(p.playing());
  EXPECT_NEAR(p.time(), 0.0075, 1e-12);
  p.advance(10.05);  // several rounds
  EXPECT_LT(p.time(), p.duration());
}

TEST(Player, OfASingleRowShowsIt) {
  Player p = player(1);
  p.play();
  p.advance(3);
  p.step(5);
  p.seek(2);
  EXPECT_EQ(p.index(), 0u);
}

TEST(Player, PlaysAStretchToItsEnd) {
  Player p = player(10000);
  p.play_between(2, 3);
  EXPECT_TRUE(p.playing());
  EXPECT_EQ(p.time(), 2);
  for (int frame = 0; frame < 55; ++frame) p.advance(0.02);
  EXPECT_FALSE(p.playing());
  EXPECT_NEAR(p.time(), 3, 1e-9);
  p.play();  // play goes on from there
  for (int frame = 0; frame < 100; ++frame) p.advance(0.02);
  EXPECT_NEAR(p.time(), 5, 1e-9);
}

TEST(Player, PlaysAStretchAgainAndAgainWhileLooping) {
  Player p = player(10000);
  p.loop = true;
  p.play_between(2, 3);
  for (int frame = 0; frame < 125; ++frame) {
    p.advance(0.02);
    EXPECT_GE(p.time(), 2);
    EXPECT_LT(p.time(), 3);
  }
  EXPECT_NEAR(p.time(), 2.5, 1e-6);
  p.seek(1);  // leaves the selected stretch
  for (int frame = 0; frame < 125; ++frame) p.advance(0.02);
  EXPECT_NEAR(p.time(), 3.5, 1e-6);
}

}  // namespace
}  // namespace limpid
