// The live session as the window has it: what it says, and what its end leaves on the terminal.
#include "app/desktop/live/live_stage.h"

#include <fmt/format.h>
#include <imgui.h>

#include <stdexcept>

#include "app/desktop/base/thumbnails.h"
#include "devices/files/session/session_file.h"
#include "tests/app/desktop/shell/a_desktop.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

struct ALiveStage : ADesktop {
  // A written file is offered for a while of ImGui's time.
  void SetUp() override {
    ImGui::CreateContext();
    setenv("XDG_CACHE_HOME", (dir / "cache").c_str(), 1);
    ADesktop::SetUp();
  }
  void TearDown() override {
    ADesktop::TearDown();
    ImGui::DestroyContext();
  }
  LiveStage& live() const { return desktop->live; }
  std::string last_said() const {
    return desktop->notices.all().empty() ? "" : desktop->notices.all().back().text;
  }
  std::vector<std::string> notes() const {
    std::vector<std::string> all;
    for (const PlotMark& mark : live().stage().history.marks()) {
      if (mark.key == kNoteMark) all.push_back(mark.label);
    }
    return all;
  }
};

// The window is gone by then: the terminal is told.
TEST_F(ALiveStage, TellsTheTerminalWhatCouldNotBeWrittenAtItsEnd) {
  live().save_beside([] { return PlotNotice{"No room for a table", true}; });
  live().save_beside([] { return PlotNotice{"Saved a table"}; });
  live().save_beside([]() -> PlotNotice { throw std::runtime_error("no folder"); });
  testing::internal::CaptureStderr();
  desktop->drop_pictures();
  desktop.reset();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("limpid: No room for a table\n"));
  EXPECT_THAT(said, HasSubstr("limpid: no folder\n")) << "one failure hides no other";
  EXPECT_THAT(said, Not(HasSubstr("Saved a table")));
}

TEST_F(ALiveStage, SaysWhatWasWrittenOnceAndWhere) {
  const auto file = dir / "table.csv";
  live().save_beside([file] { return PlotNotice{"", false, file}; });
  std::filesystem::path written;
  ASSERT_TRUE(until([&] {
    if (written.empty()) written = desktop->exporter.written();
    return !written.empty();
  }));
  EXPECT_EQ(written, file);
  EXPECT_TRUE(live().take_written().empty()) << "the banner has taken it";
  EXPECT_TRUE(desktop->notices.all().empty()) << "without a text";
}

TEST_F(ALiveStage, TellsItsPace) {
  EXPECT_EQ(live().pace_text(), "");
  live().controls().slow = 10;
  EXPECT_EQ(live().pace_text(), "1/10 speed");
  live().pause(true);
  EXPECT_EQ(live().pace_text(), "paused");
  EXPECT_TRUE(live().paused());
  EXPECT_EQ(live().why_time_is_fixed(), "");
  live().pause(false);
  live().controls().slow = 1;
  EXPECT_EQ(live().pace_text(), "");
  live().controls().slow = 10;
  plug_in(3);
  EXPECT_EQ(live().pace_text(), "") << "a real device cannot be slowed";
  live().pause(true);
  EXPECT_FALSE(live().paused());
  EXPECT_THAT(live().why_time_is_fixed(), HasSubstr("cannot be paused with a real device"));
  EXPECT_THAT(live().why_lanes_are_fixed(), HasSubstr("one hand cannot hold two real devices"));
}

TEST_F(ALiveStage, StartsOverAndSaysWhetherThereIsForce) {
  ASSERT_TRUE(armed());
  Controls& controls = live().controls();
  controls.grab = controls.magnet = true;
  controls.pull.body = 3;
  const auto resets = controls.resets;
  live().start_over();
  EXPECT_FALSE(controls.grab || controls.magnet);
  EXPECT_EQ(controls.pull, BodyPull{});
  EXPECT_EQ(controls.resets, resets + 1);
  EXPECT_EQ(last_said(), "The simulation has started over, at rest.");
  desktop->cut_force();
  ASSERT_TRUE(until([&] { return arming() == Arming::off; }));
  live().start_over();
  EXPECT_EQ(last_said(),
            "The simulation has started over, at rest and without force. Key F switches the force "
            "on.");
  record_something();
  const auto before = controls.resets;
  live().start_over();
  EXPECT_EQ(last_said(), "Stop the recording before you start over.");
  EXPECT_TRUE(desktop->notices.all().back().bad);
  EXPECT_EQ(controls.resets, before);
  live().toggle_magnet();
  EXPECT_FALSE(controls.magnet) << "nothing here can be picked up";
  EXPECT_EQ(last_said(), "The magnet is off.");
}

// A mark that is begun in a recording and set after its end stands in the plots alone.
TEST_F(ALiveStage, SaysThatAMarkComesTooLateForItsRecording) {
  const LiveStage::Moment outside = live().now();
  EXPECT_FALSE(outside.row);
  EXPECT_EQ(outside.recording, nullptr);
  record_something();
  const LiveStage::Moment inside = live().now();
  ASSERT_TRUE(inside.row);
  EXPECT_EQ(inside.recording, loop().recorder());
  EXPECT_EQ(inside.time, live().stage().history.end_time());
  live().note(inside, "in time");
  live().note(outside, "from before");
  EXPECT_FALSE(said("only in the plots"));
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded "); }));
  live().note(inside, "too late");
  EXPECT_TRUE(
      said("The recording has ended. The mark is only in the plots, not in the recording."));
  EXPECT_EQ(notes().size(), 3u);
  const Session session = read_session(recordings().at(0));
  ASSERT_EQ(session.marks.size(), 1u);
  EXPECT_EQ(session.marks[0].text, "in time");
  EXPECT_EQ(session.marks[0].tick, *inside.row);
}

TEST_F(ALiveStage, ShowsTheNewestMarksAndSaysSo) {
  const History& history = live().stage().history;
  while (history.marks().size() < History::kMostMarks) live().note(live().now(), "one");
  EXPECT_FALSE(said("The plots show only the newest"));
  live().note(live().now(), "the last");
  EXPECT_TRUE(
      said(fmt::format("The plots show only the newest {} marks. A recording keeps all "
                       "marks.",
                       History::kMostMarks)));
  EXPECT_EQ(history.marks().size(), History::kMostMarks);
  EXPECT_EQ(history.marks().back().label, "the last");
}

TEST_F(ALiveStage, NamesWhatItHasRecordedAndPlaysIt) {
  record_something();
  EXPECT_EQ(live().why_lanes_are_fixed(), "Stop the recording before you add or end a run.");
  EXPECT_TRUE(std::ranges::any_of(live().stage().history.marks(), [](const PlotMark& mark) {
    return mark.key == kRecordingMark && mark.label == "recording";
  }));
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded "); }));
  const auto file = recordings().at(0);
  EXPECT_TRUE(said(fmt::format("Recorded {}. Play it with P.", file.filename().string())));
  EXPECT_EQ(desktop->playback.last(), file);
  EXPECT_EQ(desktop->settings.recent.front(), file.string());
  EXPECT_FALSE(live().take_recorded()) << "it was taken";
  EXPECT_EQ(live().last_recording().file, file);
  EXPECT_TRUE(std::filesystem::exists(thumbnail_of(file))) << "its picture in lists";
}

TEST_F(ALiveStage, RefusesBesideTheLoopASceneWithOtherThingsThatMove) {
  SceneDocument document;
  Object ball{"ball", pose_at({0.2, 0, 0.1}), Sphere{0.01}};
  ball.body.emplace();
  document.scene.add(ball);
  try {
    live().open_beside(document, MeshModels(1), Parameters{}, 10);
    ADD_FAILURE() << "it was taken";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(),
                 "This scene has 1 objects that move, but the present scene has 0. Choose the "
                 "virtual arm before you open this scene.");
  }
}

}  // namespace
}  // namespace limpid
