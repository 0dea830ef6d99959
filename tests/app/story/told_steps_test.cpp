// Story of a session: kept in the file and shown again.
#include <gmock/gmock.h>

#include "app/story/run_story.h"
#include "devices/files/text_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

ToldSteps two_steps() {
  return {"Two \"steps\"",
          {{.begins = 0,
            .ends = 2.5,
            .caption = "One \xCE\xB7.",
            .mark = "",
            .names = {"left", "right"},
            .beside = false,
            .anew = false,
            .camera = StoryCamera{Camera::View::top, {}}},
           {.begins = 2.5,
            .ends = 4,
            .caption = "Two.",
            .mark = "pressed",
            .names = {"a", "b"},
            .beside = true,
            .anew = true,
            .camera =
                StoryCamera{Camera::View::side, Bounds(Vec3(0.1, -0.1, 0), Vec3(0.3, 0.1, 0.2))}}}};
}

TEST(ToldSteps, ComeBackAsTheyWere) {
  const ToldSteps told = two_steps(), again = read_told(told_text(told), "here");
  EXPECT_EQ(again.title, told.title);
  ASSERT_EQ(again.steps.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const StoryStep &a = told.steps[i], &b = again.steps[i];
    EXPECT_EQ(a.begins, b.begins);
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.caption, b.caption);
    EXPECT_EQ(a.mark, b.mark);
    EXPECT_EQ(a.names, b.names);
    EXPECT_EQ(a.beside, b.beside);
    EXPECT_EQ(a.anew, b.anew);
    ASSERT_TRUE(b.camera);
    EXPECT_EQ(a.camera->view, b.camera->view);
    EXPECT_EQ(a.camera->of.has_value(), b.camera->of.has_value());
  }
  EXPECT_TRUE(told.steps[1].camera->of->isApprox(*again.steps[1].camera->of, 1e-9));
}

TEST(ToldSteps, NothingTellsNothing) { EXPECT_TRUE(read_told("", "here").steps.empty()); }

TEST(ToldSteps, WhatIsDamagedIsRefusedByName) {
  const auto expect_refused = [](const std::string& text, const std::string& why) {
    try {
      read_told(text, "a.h5: story");
      FAIL() << "taken: " << text;
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.h5: story"));
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  };
  expect_refused("title = ", "");
  expect_refused("[[step]]\nbegins = 0\nends = 1\nnames = [\"a\", \"b\"]\n", "caption");
  ToldSteps turned = two_steps();
  std::swap(turned.steps[0], turned.steps[1]);
  expect_refused(told_text(turned), "one after the other");
  ToldSteps endless = two_steps();
  endless.steps[1].ends = 2.5;
  expect_refused(told_text(endless), "begins");
}

TEST(ToldSteps, GoWithASessionThroughItsFile) {
  const test::TempDir temp;
  const Story story = parse_story(
      "title = \"Short\"\nseconds = 0.4\n[[step]]\ntime = 0\ncaption = \"One.\"\n"
      "hand = [[0, 0.19, 0, 0]]\n[[step]]\ntime = 0.2\ncaption = \"Two.\"\n"
      "hand = [[0.1, 0.19, 0, 0]]\n",
      "s.toml", "/nowhere");
  const std::atomic<bool> never{false};
  const StoryRun run = run_story(story, never, [](double) {});
  const auto file = temp / "s.h5";
  write_session(run.session, {story.title, story.steps}, file, false);
  const ToldSteps again = told_in(read_session(file), file);
  EXPECT_EQ(again.title, "Short");
  ASSERT_EQ(again.steps.size(), 2u);
  EXPECT_EQ(again.steps[1].caption, "Two.");
  EXPECT_EQ(read_session(file).size(), run.session.size()) << "the rows are as they were";
}

TEST(ToldSteps, ASessionWithoutAStoryHasNone) {
  const std::string file = LIMPID_ASSETS_DIR "/sessions/table.h5";
  EXPECT_TRUE(told_in(read_session(file), file).steps.empty());
}

}  // namespace
}  // namespace limpid
