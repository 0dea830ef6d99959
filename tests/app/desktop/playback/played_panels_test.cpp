// Panels and questions of a recording that is played: its settings, its re-runs, its video.
#include <cmath>

#include "app/desktop/playback/playback.h"
#include "app/desktop/playback/recorded_panel.h"
#include "app/desktop/playback/video_dialog.h"
#include "app/desktop/widgets/modal.h"
#include "app/run/recorder.h"
#include "tests/app/desktop/widgets/read_panel.h"
#include "tests/support/computer.h"
#include "tests/support/faultless_context.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

// Four seconds of a hand that moves freely, in ticks of 10 ms.
class PlayedPanels : public ReadPanel {
 protected:
  void SetUp() override {
    if (!test::has_offscreen_pictures()) GTEST_SKIP() << "no EGL here";
    context_.emplace(64, 64);
    RunPlan plan = test::plan("free.toml", "free.csv", 1);
    plan.parameters.tick = 0.01;
    plan.parameters.hand_stiffness = 450;
    plan.rows = 400;
    Recorder recorder(file_, session_info(plan), plan.parameters, false);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return recorder.push_waiting(row); });
    recorder.finish();
    playback_.load("loading", [this](TaskProgress&) -> std::optional<LoadedSession> {
      LoadedSession loaded = load_session(file_);
      loaded.facts = {{"Point of a sweep", "7"}};
      loaded.verdict = {{"rms torque", "1.5 N m"}};
      return loaded;
    });
    ASSERT_TRUE(test::until([this] { return playback_.update(0); }));
    played().player().pause();
    played().player().seek(0);
  }
  void TearDown() override { playback_.drop_pictures(); }
  PlayedSession& played() { return *playback_.shown(); }
  // Runs the recorded hand again with another spring.
  Rerun again(double k_vc) {
    const Session& session = played().player().session();
    Parameters chosen = session_parameters(session, "mine.h5");
    chosen.k_vc = k_vc;
    TaskProgress progress;
    return run_again(session, "mine.h5", chosen, progress);
  }

  const test::TempDir dir_;
  const std::filesystem::path file_ = dir_ / "mine.h5";
  std::optional<test::FaultlessContext> context_;
  Notices notices_;
  Playback playback_{notices_};
};

TEST_F(PlayedPanels, ListFactsVerdictAndSettingsWithTheirMeaning) {
  for (const bool everything : {true, false}) {
    show([&] { draw_recorded(played(), everything); });
    EXPECT_EQ(value("Point of a sweep"), "7");
    EXPECT_EQ(value("rms torque"), "1.5 N m");
    EXPECT_EQ(hint("Point of a sweep"), "") << "it explains itself";
    EXPECT_LT(find("Point of a sweep")->max.y, find("rms torque")->min.y);
    const std::vector<Parameters> lanes = played().lane_settings();
    float below = find("rms torque")->max.y;
    for (const RecordedSetting& each : recorded_settings(lanes, everything)) {
      // A long name stands in several lines, and letters of other alphabets are not read.
      const std::string name = each.name.substr(0, each.name.find(' '));
      if (std::ranges::any_of(name, [](char c) { return c < 0; })) continue;
      std::optional<test::DrawnText> at;
      for (const test::DrawnText& text : test::drawn_texts()) {
        const bool is_name =
            text.text.starts_with(name) && text.colour == colour(current_palette().muted);
        if (!at && is_name && text.min.y > below - 2) at = text;
      }
      ASSERT_TRUE(at) << each.name << " is not in:\n" << words();
      below = at->max.y;
      EXPECT_THAT(hint(at->text), StartsWith(each.help.substr(0, 6))) << each.name;
    }
    EXPECT_THAT(words(), HasSubstr("450")) << "the grip was another one than usual";
  }
}

TEST_F(PlayedPanels, NameARerunBesideTheRecording) {
  EXPECT_FALSE(played().has_rerun());
  EXPECT_THAT(played().tried(), IsEmpty());
  EXPECT_TRUE(played().rerun_row().empty());
  Rerun first = again(20);
  const RunNames names{
      {first.run.recorded, first.run.name},
      false,
      {static_cast<int>(played().settings().kind), static_cast<int>(played().settings().kind)}};
  const std::vector<double> rows(first.run.rows.begin(), first.run.rows.end());
  played().show(std::move(first));
  EXPECT_TRUE(played().has_rerun());
  EXPECT_EQ(played().stage().names(), names);
  EXPECT_EQ(played().rows().size(), 1u) << "the recording's";
  EXPECT_EQ(played().names_now(), std::nullopt);
  ASSERT_EQ(played().changes_of_rerun().size(), 1u);
  EXPECT_THAT(played().changes_of_rerun()[0], StartsWith("coupling.k_vc=20"));
  played().player().seek(1.5);
  const auto stride = static_cast<std::size_t>(played().player().session().layout.stride());
  const auto row = played().rerun_row();
  ASSERT_EQ(row.size(), stride);
  for (std::size_t i = 0; i < stride; ++i) {
    const double wanted = rows[played().player().index() * stride + i];
    EXPECT_TRUE(row[i] == wanted || (std::isnan(row[i]) && std::isnan(wanted))) << i;
  }
}

// The recording and the newest seven re-runs are remembered.
TEST_F(PlayedPanels, RememberTheFiguresOfTheNewestReruns) {
  std::vector<std::string> names;
  for (int i = 1; i <= 9; ++i) {
    Rerun rerun = again(10 + i);
    if (i == 1) names.push_back(rerun.run.recorded_figures.name);
    names.push_back(rerun.run.figures.name);
    played().show(std::move(rerun));
    EXPECT_EQ(played().tried().size(), static_cast<std::size_t>(std::min(i + 1, 8)));
  }
  const std::vector<RunFigures>& tried = played().tried();
  EXPECT_EQ(tried.front().name, names.front());
  for (std::size_t i = 1; i < tried.size(); ++i) {
    EXPECT_EQ(tried[i].name, names[i + names.size() - tried.size()]) << i;
  }
}

TEST_F(PlayedPanels, ShowMarksInTheOrderOfTheirTicks) {
  played().show(std::vector<Mark>{{250, "later"}, {100, "sooner"}});
  ASSERT_EQ(played().marks().size(), 2u);
  EXPECT_EQ(played().marks()[0].text, "sooner");
  EXPECT_NEAR(played().time_of(played().marks()[0]), 1, 1e-12);
  EXPECT_NEAR(played().time_of(played().marks()[1]), 2.5, 1e-12);
  std::vector<std::string> in_plots;
  for (const PlotMark& mark : played().stage().history.marks()) {
    if (mark.key == kNoteMark) in_plots.push_back(mark.label);
  }
  EXPECT_THAT(in_plots, ElementsAre("sooner", "later"));
  played().show(std::vector<Mark>{});
  for (const PlotMark& mark : played().stage().history.marks()) EXPECT_NE(mark.key, kNoteMark);
}

// The dialog that asks for a video's properties, until it hands them over.
class VideoQuestions : public PlayedPanels {
 protected:
  void ask(bool overlaid = false, bool lens = false) {
    open_ = true;
    given_.reset();
    show([this, overlaid, lens] {
      if (auto request = dialog_.draw(open_, playback_, overlaid, lens)) given_ = request;
    });
  }
  // Chooses from the list whose label stands at its right.
  void choose(const char* label, const char* wanted) {
    const auto at = find(label);
    ASSERT_TRUE(at) << label << " is not in:\n" << words();
    click(ImVec2{at->min.x - 60, at->middle().y});
    click(wanted, "##Combo");
  }
  std::vector<std::string> listed(const char* label, const char* again) {
    const auto at = find(label);
    EXPECT_TRUE(at) << label;
    if (at) click(ImVec2{at->min.x - 60, at->middle().y});
    std::vector<std::string> all;
    for (const test::DrawnText& each : test::drawn_texts()) {
      if (each.window.starts_with("##Combo")) all.push_back(each.text);
    }
    click(again, "##Combo");
    return all;
  }
  VideoRequest given() {
    click("Write (Enter)");
    EXPECT_TRUE(given_);
    EXPECT_FALSE(open_);
    return given_.value_or(VideoRequest{});
  }
  double duration() { return played().player().duration(); }
  std::string sum(double seconds, double rate) {
    return fmt::format("{:.1f} s, {:.0f} pictures, drawn at full quality", seconds,
                       std::round(seconds * rate));
  }

  VideoDialog dialog_;
  bool open_ = false;
  std::optional<VideoRequest> given_;
};

TEST_F(VideoQuestions, GiveTheWholeRecordingAsItWas) {
  ask();
  EXPECT_THAT(sentences(), AllOf(HasSubstr(sum(duration(), 30)), HasSubstr("mine.mp4")));
  const auto plots = find("with the plots"), lens = find("with the lens");
  ASSERT_TRUE(plots && lens) << words();
  EXPECT_NEAR(plots->middle().y, lens->middle().y, 2) << "side by side";
  EXPECT_LT(plots->max.x, lens->min.x);
  const auto write = find("Write (Enter)"), cancel = find("Cancel (Esc)");
  ASSERT_TRUE(write && cancel);
  EXPECT_NEAR(write->middle().y, cancel->middle().y, 1);
  EXPECT_LT(write->max.x, cancel->min.x);
  EXPECT_FALSE(find("all runs in one picture")) << "there is one";
  EXPECT_FALSE(find("with the re-run")) << "there is none";
  const VideoRequest order = given();
  EXPECT_EQ(order.kind, VideoRequest::Kind::mp4);
  EXPECT_EQ(order.width, 1280);
  EXPECT_EQ(order.height, 720);
  EXPECT_EQ(order.fps, 30);
  EXPECT_EQ(order.speed, 1);
  EXPECT_TRUE(order.plots);
  EXPECT_FALSE(order.lens || order.overlaid);
  EXPECT_EQ(order.from, 0);
  EXPECT_EQ(order.to, std::nullopt) << "to its end";
  EXPECT_THAT(order.rerun, IsEmpty());
}

TEST_F(VideoQuestions, TakeFormatSizeRateAndSpeed) {
  ask(false, true);
  EXPECT_THAT(listed("size", "1280 x 720"),
              ElementsAre("640 x 360", "854 x 480", "1280 x 720", "1920 x 1080", "1080 x 1080"));
  EXPECT_THAT(listed("pictures per second", "30"),
              ElementsAre("10", "15", "24", "25", "30", "50", "60"));
  EXPECT_THAT(listed("speed", "as it was"),
              ElementsAre("x0.1", "x0.2", "x0.5", "as it was", "x2", "x5"));
  choose("size", "854 x 480");
  choose("speed", "x2");
  choose("pictures per second", "25");
  EXPECT_THAT(sentences(), HasSubstr(sum(duration() / 2, 25)));
  choose("format", "GIF, for a web page or slides");
  EXPECT_THAT(sentences(), AllOf(HasSubstr(sum(duration() / 2, 15)), HasSubstr("mine.gif")))
      << "a format has a rate of its own";
  choose("pictures per second", "60");
  EXPECT_THAT(sentences(), HasSubstr(sum(duration() / 2, 50))) << "a GIF has no more";
  click("with the plots");
  const VideoRequest order = given();
  EXPECT_EQ(order.kind, VideoRequest::Kind::gif);
  EXPECT_EQ(order.width, 854);
  EXPECT_EQ(order.height, 480);
  EXPECT_EQ(order.fps, 50);
  EXPECT_EQ(order.speed, 2);
  EXPECT_FALSE(order.plots);
  EXPECT_TRUE(order.lens) << "as in the window";
  ask();
  EXPECT_THAT(sentences(), HasSubstr(sum(duration() / 2, 50))) << "as it was asked for last";
  EXPECT_FALSE(given().lens) << "but for the window's own choices";
}

TEST_F(VideoQuestions, LeaveTheRerunOutWhereItsBoxIsEmpty) {
  played().show(again(20));
  ask();
  ASSERT_TRUE(find("with the re-run"));
  const std::vector<std::string> changes = given().rerun;
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_THAT(changes[0], StartsWith("coupling.k_vc=20"));
  ask();
  click("with the re-run");
  EXPECT_THAT(given().rerun, IsEmpty());
}

TEST_F(VideoQuestions, AreAnsweredByEnterAndLeftByTheirButton) {
  ask();
  frames(5);
  for (const bool down : {true, false}) {
    show_key(GLFW_KEY_ENTER, down);
    frames(1);
  }
  EXPECT_TRUE(given_);
  EXPECT_FALSE(open_);
  ask();
  click("Cancel (Esc)");
  EXPECT_FALSE(given_);
  EXPECT_FALSE(open_);
  frames();
  EXPECT_FALSE(find("Write (Enter)"));
  playback_.close();
  ask();
  EXPECT_FALSE(open_) << "nothing is played";
}

}  // namespace
}  // namespace limpid
