// Words in the pictures of films, read back from their letters. Skipped where EGL gives no context
// or Inter is not installed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "app/film/session_film.h"
#include "app/story/run_story.h"
#include "tests/app/film/read_video.h"
#include "tests/support/computer.h"
#include "tests/support/drawn_text.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

const std::string kFilmStory = R"(title = "Words"
seconds = 0.4
[[step]]
time = 0
caption = "One law."
beside = false
first = ["coupling.kind = standard"]
twin = ["coupling.kind = predictive"]
hand = [[0, 0.19, 0, 0], [0.1, 0.19, 0.03, 0], [0.19, 0.19, 0.03, 0.03]]
[[step]]
time = 0.2
caption = "Two laws."
mark = "now"
names = ["one", "other"]
)";

// At three quarters of the usual scale: a caption of 20 px, and plots of 178 px.
constexpr int kFilmWide = 960, kFilmHigh = 540, kPlotsFrom = 540 - 178;

class FilmWords : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    if (!test::has_inter()) GTEST_SKIP() << "Inter is not installed";
  }
  static const StoryRun& told() {
    static const StoryRun run = run_story(story(), std::atomic<bool>{false}, [](double) {});
    return run;
  }
  static const Story& story() {
    static const Story story = parse_story(kFilmStory, "s.toml", "/nowhere");
    return story;
  }
  // The first run alone.
  static Session alone() {
    Session session = told().session;
    session.beside.clear();
    return session;
  }
  // Makes a film of ten pictures a second and keeps what each of them says.
  void make(const Session& session, FilmOrder order = {}, const char* name = "film") {
    order.out = dir_ / name;
    if (order.look.width == FilmLook{}.width) {
      order.look.width = kFilmWide;
      order.look.height = kFilmHigh;
    }
    if (!order.fps) order.fps = 10;
    pictures_.clear();
    film(session, "mine.h5", order, std::atomic<bool>{false},
         [&](double) { pictures_.push_back(test::drawn_texts()); });
  }
  const test::DrawnText* find(std::size_t picture, const std::string& text) const {
    const auto& all = pictures_.at(picture);
    const auto found = std::ranges::find(all, text, &test::DrawnText::text);
    return found == all.end() ? nullptr : &*found;
  }
  bool says(std::size_t picture, const std::string& text) const {
    return find(picture, text) != nullptr;
  }
  const test::DrawnText* begins(std::size_t picture, const std::string& text) const {
    const auto& all = pictures_.at(picture);
    const auto found = std::ranges::find_if(
        all, [&](const test::DrawnText& each) { return each.text.starts_with(text); });
    return found == all.end() ? nullptr : &*found;
  }
  std::string file(const char* name, int number) const {
    std::ifstream in(dir_ / name / fmt::format("frame-{:06}.png", number), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const test::TempDir dir_;
  std::vector<std::vector<test::DrawnText>> pictures_;
};

TEST_F(FilmWords, SayTimeSettingsAndTitleInTheCaption) {
  make(alone(), {.from = 0.1, .to = 0.3, .speed = 0.5, .title = "A title"});
  ASSERT_EQ(pictures_.size(), 4u);
  const std::array times{"0.10 s", "0.15 s", "0.20 s", "0.25 s"};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto* time = find(i, times[i]);
    ASSERT_TRUE(time) << times[i];
    EXPECT_NEAR(time->at.x, 9, 1.5);
    EXPECT_LT(time->max.y, 21);
    const auto* law = begins(i, "standard coupling,");
    ASSERT_TRUE(law);
    EXPECT_NE(law->text.find("1.00,"), std::string::npos) << "eta: " << law->text;
    EXPECT_TRUE(law->text.ends_with(" N m s/rad")) << law->text;
    EXPECT_NEAR(law->at.x, time->max.x + 18, 4) << "behind the time";
    const auto* title = find(i, "A title");
    ASSERT_TRUE(title);
    EXPECT_NEAR(title->max.x, kFilmWide - 9, 3);
    EXPECT_NEAR(title->middle().y, time->middle().y, 4);
  }
  make(alone(), {.to = 0.1, .title = std::string(300, 'w')}, "second");
  EXPECT_FALSE(begins(0, "www")) << "where there is no room";
}

TEST_F(FilmWords, HaveALegendAndFourPlots) {
  make(alone(), {.to = 0.1});
  const auto* device = find(0, "device (ghost)");
  ASSERT_TRUE(device);
  EXPECT_LT(device->at.x, 60);
  EXPECT_GT(device->min.y, 20);
  EXPECT_LT(device->max.y, 80);
  for (const char* entry : {"proxy", "hand", "contact force, 1 N = 2 cm"}) {
    EXPECT_TRUE(says(0, entry)) << entry;
  }
  float left = -200;
  for (const char* title : {"coordination error", "controller energy", "human and contact torque",
                            "error against torque"}) {
    const auto* plot = find(0, title);
    ASSERT_TRUE(plot) << title;
    EXPECT_GT(plot->min.y, kPlotsFrom);
    EXPECT_GT(plot->at.x, left + 200);
    left = plot->at.x;
  }
  make(alone(), {.look = {.width = 480, .height = 320}, .to = 0.1}, "small");
  EXPECT_TRUE(says(0, "device")) << "short words";
  EXPECT_TRUE(says(0, "coordination error"));
  EXPECT_TRUE(begins(0, "controller"));
  EXPECT_FALSE(begins(0, "human and")) << "two plots have room";
  make(alone(), {.look = {.plots = false}, .to = 0.1}, "bare");
  EXPECT_FALSE(says(0, "coordination error"));
}

TEST_F(FilmWords, AreAsLargeAsTheyAreAskedToBe) {
  const auto height = [&](double scale, const char* name) {
    make(alone(), {.look = {.plots = false, .text_scale = scale}, .to = 0.1}, name);
    const auto* time = begins(0, "0.00");
    return time == nullptr ? 0.0f : time->max.y - time->min.y;
  };
  const float usual = height(1, "one");
  EXPECT_NEAR(height(0, "by itself") / usual, 0.75, 0.1) << "by its size";
  EXPECT_NEAR(height(2, "two") / usual, 2, 0.2);
}

TEST_F(FilmWords, TellAStoryStepByStep) {
  make(told().session, {.steps = story().steps});
  ASSERT_EQ(pictures_.size(), 4u);
  for (const std::size_t i : {0u, 1u}) {
    const auto* sentence = find(i, "One law.");
    ASSERT_TRUE(sentence);
    EXPECT_NEAR(sentence->middle().x, kFilmWide / 2, 4);
    EXPECT_GT(sentence->min.y, kPlotsFrom - 45);
    EXPECT_LT(sentence->max.y, kPlotsFrom);
    EXPECT_TRUE(begins(i, "standard coupling,"));
    EXPECT_FALSE(says(i, "Two laws.") || says(i, "one") || says(i, "now"));
  }
  for (const std::size_t i : {2u, 3u}) {
    EXPECT_TRUE(says(i, "Two laws."));
    EXPECT_FALSE(says(i, "One law."));
    EXPECT_TRUE(says(i, "one  |  other")) << "in the caption";
    EXPECT_FALSE(begins(i, "standard coupling,"));
    EXPECT_TRUE(says(i, "now")) << "in the plots";
    // Names stand over the middle of their halves, behind a sample of their curves.
    const auto *one = find(i, "one"), *other = find(i, "other");
    ASSERT_TRUE(one && other);
    EXPECT_NEAR(one->middle().x, 240 + 9, 6);
    EXPECT_NEAR(other->middle().x, 720 + 9, 6);
    EXPECT_LT(one->max.y, 55);
    // The legend is short, and below the names.
    ASSERT_TRUE(says(i, "device"));
    EXPECT_GT(find(i, "device")->min.y, one->max.y);
  }
}

TEST_F(FilmWords, BeginPlotsAnewWithAStep) {
  std::vector<StoryStep> steps = story().steps;
  steps[0].mark = "first";
  make(told().session, {.steps = steps}, "on");
  EXPECT_TRUE(says(1, "first"));
  EXPECT_TRUE(says(3, "first"));
  steps[1].anew = true;
  make(told().session, {.steps = steps}, "anew");
  EXPECT_TRUE(says(1, "first"));
  EXPECT_FALSE(says(3, "first"));
  EXPECT_TRUE(says(3, "now"));
  make(told().session, {.from = 0.1, .steps = steps}, "later");
  EXPECT_FALSE(says(0, "first")) << "it began before";
}

TEST_F(FilmWords, SayWhatHappenedWhen) {
  Session session = alone();
  session.marks.push_back({150, "here"});
  session.changes.push_back({100, "coupling.b_v = 0.02"});
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 250; k < session.size(); ++k) {
    session.layout.in(std::span(session.rows).subspan(k * stride, stride), Column::force_state)[0] =
        1;
  }
  make(session);
  ASSERT_EQ(pictures_.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(says(i, "here"), i >= 2) << i;
    EXPECT_EQ(says(i, "coupling.b_v = 0.02"), i >= 1) << i;
    EXPECT_FALSE(says(i, "now")) << "of no story";
  }
  EXPECT_FALSE(begins(2, "force off"));
  const auto& last = pictures_[3];
  EXPECT_TRUE(std::ranges::any_of(last, [](const test::DrawnText& each) {
    return each.text == "force off: not armed" && std::abs(each.middle().x - kFilmWide / 2) < 3 &&
           each.min.y > 20 && each.max.y < 80;
  })) << "over the picture";
}

TEST_F(FilmWords, ShowRunsInOnePictureByTheirNames) {
  make(told().session, {.look = {.overlaid = true}, .to = 0.1});
  ASSERT_EQ(pictures_.size(), 1u);
  EXPECT_TRUE(says(0, "standard  |  predictive"));
  EXPECT_TRUE(says(0, "device (ghost)")) << "one legend, in lines";
  const auto* name = find(0, "standard");
  ASSERT_TRUE(name);
  EXPECT_LT(name->at.x, 80) << "in the legend";
  make(told().session, {.to = 0.1}, "halves");
  EXPECT_FALSE(says(0, "device (ghost)"));
  EXPECT_TRUE(says(0, "device"));
}

TEST_F(FilmWords, NameARerun) {
  make(alone(), {.to = 0.2});
  EXPECT_FALSE(says(1, "proxy of the re-run (ghost)"));
  make(alone(), {.to = 0.2, .rerun = {"coupling.kind=predictive"}}, "again");
  ASSERT_EQ(pictures_.size(), 2u);
  EXPECT_TRUE(says(1, "proxy of the re-run (ghost)"));
  const auto* caption = begins(1, "standard coupling,");
  ASSERT_TRUE(caption);
  EXPECT_NE(caption->text.find("N m s/rad  |  "), std::string::npos) << caption->text;
}

// Device and proxy are 0.02 rad apart: about 4 mm at the tip.
TEST_F(FilmWords, HaveTheGapAndALensWhereThatIsAskedFor) {
  Session session = alone();
  const auto stride = static_cast<std::size_t>(session.layout.stride());
  for (std::size_t k = 0; k < session.size(); ++k) {
    const auto row = std::span(session.rows).subspan(k * stride, stride);
    const auto from = session.layout.in(row, Column::proxy_position);
    const auto to = session.layout.in(row, Column::device_position);
    std::ranges::copy(from, to.begin());
    to[0] += 0.02;
  }
  make(session, {.to = 0.1});
  EXPECT_FALSE(begins(0, "gap")) << "of one run alone";
  EXPECT_FALSE(begins(0, "x5"));
  make(session, {.look = {.lens = true}, .to = 0.1}, "lens");
  EXPECT_TRUE(begins(0, "x5"));
}

// The trail of the second before is in the first picture.
TEST_F(FilmWords, BeginWithTheTrailOfWhatWasBefore) {
  const FilmLook look{.width = 480, .height = 320, .plots = false};
  make(alone(), {.look = look, .to = 0.4}, "whole");
  make(alone(), {.look = look, .from = 0.3, .to = 0.4}, "later");
  ASSERT_EQ(pictures_.size(), 1u);
  EXPECT_FALSE(file("later", 1).empty());
  EXPECT_EQ(file("later", 1), file("whole", 4));
  EXPECT_NE(file("later", 1), file("whole", 3));
}

// A step's view is that of its picture, from its beginning on.
TEST_F(FilmWords, LookWhereTheStorySays) {
  const FilmLook look{.width = 480, .height = 320, .plots = false};
  std::vector<StoryStep> steps = story().steps;
  const Vec3 tip(0.19, 0, 0);
  const auto around = [&](double size) {
    return Bounds(tip - Vec3::Constant(size), tip + Vec3::Constant(size));
  };
  const auto first = [&](Camera::View view, std::optional<Bounds> of, const char* name) {
    steps[0].camera = StoryCamera{view, of};
    make(told().session, {.look = look, .to = 0.1, .steps = steps}, name);
    return file(name, 1);
  };
  const std::string near = first(Camera::View::side, around(0.03), "near");
  const std::string far = first(Camera::View::side, around(0.2), "far");
  const std::string top = first(Camera::View::top, around(0.2), "top");
  const std::string all = first(Camera::View::side, {}, "all");
  EXPECT_FALSE(near.empty());
  EXPECT_NE(near, far);
  EXPECT_NE(far, top);
  EXPECT_NE(all, far);
  EXPECT_NE(all, near);
  EXPECT_EQ(first(Camera::View::side, around(0.03), "again"), near);
}

}  // namespace
}  // namespace limpid
