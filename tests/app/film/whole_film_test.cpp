// Whole films of short runs: their pictures, what each of them shows, and that they can be stopped.
// Skipped where EGL gives no context.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "app/film/session_film.h"
#include "app/run/replay.h"
#include "core/tick/arming.h"
#include "tests/app/film/read_video.h"
#include "tests/support/computer.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class WholeFilms : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
  }

  // A run onto the table, with further runs of these laws.
  static Session recorded(double seconds, const std::vector<CouplingKind>& beside = {}) {
    RunPlan plan = test::plan("table.toml", "touch.csv", seconds);
    plan.parameters.kind = CouplingKind::standard;
    for (const CouplingKind kind : beside) {
      Lane lane{plan.parameters, {}};
      lane.parameters.kind = kind;
      plan.beside.push_back(lane);
    }
    Session session;
    session.info = session_info(plan);
    session.layout = plan.layout();
    session.beside.resize(beside.size());
    for (std::size_t i = 0; i < beside.size(); ++i) {
      session.beside[i].layout = session.layout;
      session.beside[i].info = session.info;
      session.beside[i].info.config = session.info.beside.at(i);
      session.beside[i].info.beside.clear();
    }
    const auto stride = static_cast<std::size_t>(session.layout.stride());
    simulate(plan, {}, [&](std::span<const double> rows, LaneChanges) {
      for (std::size_t i = 0; i < session.lanes(); ++i) {
        const auto row = rows.subspan(i * stride, stride);
        session.lane(i).rows.insert(session.lane(i).rows.end(), row.begin(), row.end());
      }
      return true;
    });
    return session;
  }
  // A film of small pictures in a folder of that name.
  FilmEnd make(const Session& session, const char* name, FilmOrder order = {}) {
    order.out = dir_ / name;
    order.look.width = 480;
    order.look.height = 320;
    if (!order.fps) order.fps = 10;
    parts_.clear();
    return film(session, "mine.h5", order, stop_, [this](double part) { parts_.push_back(part); });
  }
  fs::path picture(const char* name, int number) const {
    return dir_ / name / fmt::format("frame-{:06}.png", number);
  }
  std::size_t pictures(const char* name) const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(dir_ / name), fs::directory_iterator()));
  }
  // Whether the n-th pictures of two films are the same.
  bool same(const char* a, const char* b, int number) const {
    const std::string one = bytes_of(picture(a, number));
    EXPECT_FALSE(one.empty()) << a;
    return one == bytes_of(picture(b, number));
  }

  const test::TempDir dir_;
  std::atomic<bool> stop_{false};
  std::vector<double> parts_;
};

TEST_F(WholeFilms, HaveOnePictureForEachMoment) {
  const FilmEnd end = make(recorded(0.5), "whole");
  EXPECT_FALSE(end.stopped);
  EXPECT_NEAR(end.seconds, 0.5, 1e-9);
  EXPECT_EQ(pictures("whole"), 5u);
  ASSERT_GE(parts_.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(parts_[i], 0.2 * static_cast<double>(i + 1), 1e-9);
  const SeenVideo seen = read_video(picture("whole", 1));
  EXPECT_EQ(seen.width, 480);
  EXPECT_EQ(seen.height, 320);
  for (int i = 2; i <= 5; ++i) {
    EXPECT_NE(bytes_of(picture("whole", i)), bytes_of(picture("whole", i - 1))) << "time goes on";
  }
}

TEST_F(WholeFilms, LastAsLongAsTheirSpeedSays) {
  const Session session = recorded(0.5);
  EXPECT_NEAR(make(session, "slow", {.speed = 0.5}).seconds, 1, 1e-9);
  EXPECT_EQ(pictures("slow"), 10u);
  EXPECT_NEAR(make(session, "part", {.from = 0.1, .to = 0.4}).seconds, 0.3, 1e-9);
  EXPECT_EQ(pictures("part"), 3u);
}

TEST_F(WholeFilms, AreTheSameOfTheSameSession) {
  const Session session = recorded(0.3);
  make(session, "one");
  make(session, "two");
  for (const int i : {1, 2, 3}) EXPECT_TRUE(same("one", "two", i)) << i;
}

TEST_F(WholeFilms, CanBeStopped) {
  stop_ = true;
  const FilmEnd end = make(recorded(0.5), "stopped");
  EXPECT_TRUE(end.stopped);
  EXPECT_EQ(end.seconds, 0);
  EXPECT_FALSE(fs::exists(dir_ / "stopped"));
  const Session session = recorded(0.5);
  stop_ = false;
  FilmOrder order;
  order.out = dir_ / "later";
  order.look.width = 480;
  order.look.height = 320;
  order.fps = 10;
  const FilmEnd later = film(session, "mine.h5", order, stop_, [this](double part) {
    if (part > 0.5) stop_ = true;  // after the third of five
  });
  EXPECT_TRUE(later.stopped);
  EXPECT_NEAR(later.seconds, 0.3, 1e-9);
  EXPECT_FALSE(fs::exists(dir_ / "later"));
}

TEST_F(WholeFilms, OfAGifLeaveTimeForItsColours) {
  FilmOrder order;
  order.out = dir_ / "a.gif";
  order.look.width = 240;
  order.look.height = 160;
  order.fps = 10;
  std::vector<double> parts;
  const FilmEnd end =
      film(recorded(0.3), "mine.h5", order, stop_, [&](double part) { parts.push_back(part); });
  EXPECT_FALSE(end.stopped);
  ASSERT_GT(parts.size(), 3u);
  EXPECT_NEAR(parts[0], 0.7 / 3, 1e-9);
  EXPECT_NEAR(parts[2], 0.7, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(parts));
  EXPECT_LE(parts.back(), 1 + 1e-9);
  EXPECT_EQ(read_video(dir_ / "a.gif").left.size(), 3u);
}

TEST_F(WholeFilms, SayMoreWhereThereIsMore) {
  const Session session = recorded(0.3);
  make(session, "plain");
  make(session, "titled", {.title = "A title"});
  EXPECT_FALSE(same("plain", "titled", 2));
  Session marked = session;
  marked.marks.push_back({50, "here"});
  make(marked, "marked");
  EXPECT_TRUE(same("plain", "marked", 1)) << "before it";
  EXPECT_FALSE(same("plain", "marked", 2)) << "in its plots from then on";
  Session changed = session;
  changed.changes.push_back({150, "coupling.b_v = 0.02"});
  make(changed, "changed");
  EXPECT_TRUE(same("plain", "changed", 2));
  EXPECT_FALSE(same("plain", "changed", 3));
  Session off = session;
  const auto stride = static_cast<std::size_t>(off.layout.stride());
  for (std::size_t k = 150; k < off.size(); ++k) {
    off.layout.in(std::span(off.rows).subspan(k * stride, stride), Column::force_state)[0] =
        static_cast<double>(ForceState::off);
  }
  make(off, "off");
  EXPECT_TRUE(same("plain", "off", 2));
  EXPECT_FALSE(same("plain", "off", 3)) << "a sign over the picture";
}

TEST_F(WholeFilms, ShowRunsInPartsOrInOnePicture) {
  const Session session = recorded(0.3, {CouplingKind::predictive});
  make(session, "halves");
  make(session, "one", {.look = {.overlaid = true}});
  make(recorded(0.3), "alone");
  EXPECT_EQ(pictures("halves"), 3u);
  EXPECT_FALSE(same("halves", "one", 3));
  EXPECT_FALSE(same("halves", "alone", 3));
  EXPECT_FALSE(same("one", "alone", 3));
}

TEST_F(WholeFilms, ShowARerunBesideTheRecording) {
  const Session session = recorded(0.4);
  make(session, "recorded");
  const FilmEnd end = make(session, "again", {.rerun = {"coupling.kind=predictive"}});
  EXPECT_FALSE(end.stopped);
  EXPECT_EQ(pictures("again"), 4u);
  EXPECT_FALSE(same("recorded", "again", 1)) << "the re-run has a name";
  EXPECT_FALSE(same("recorded", "again", 4));
}

TEST_F(WholeFilms, TellAStory) {
  const Session session = recorded(0.4, {CouplingKind::predictive});
  const std::vector<StoryStep> steps{{.begins = 0,
                                      .ends = 0.2,
                                      .caption = "One law.",
                                      .mark = "",
                                      .names = {"one"},
                                      .beside = false},
                                     {.begins = 0.2,
                                      .ends = 0.4,
                                      .caption = "Two laws.",
                                      .mark = "now",
                                      .names = {"one", "other"}}};
  make(session, "told", {.steps = steps});
  make(session, "plain");
  EXPECT_EQ(pictures("told"), 4u);
  for (const int i : {1, 4}) EXPECT_FALSE(same("told", "plain", i)) << i;
  std::vector<StoryStep> other = steps;
  other[1].caption = "Something else.";
  make(session, "other", {.steps = other});
  EXPECT_TRUE(same("told", "other", 2)) << "the first step is the same";
  EXPECT_FALSE(same("told", "other", 3));
  other = steps;
  other[1].anew = true;
  make(session, "anew", {.steps = other});
  EXPECT_FALSE(same("told", "anew", 4)) << "the plots begin anew";
  other = steps;
  other[0].beside = true;
  make(session, "beside", {.steps = other});
  EXPECT_FALSE(same("told", "beside", 1)) << "the other run is shown, too";
}

TEST_F(WholeFilms, AreDarkOrLight) {
  const Session session = recorded(0.2);
  make(session, "dark");
  make(session, "light", {.look = {.theme = Theme::light}});
  const SeenVideo dark = read_video(picture("dark", 1)), light = read_video(picture("light", 1));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(light.left.at(0)[i], dark.left.at(0)[i] + 50);
}

}  // namespace
}  // namespace limpid
