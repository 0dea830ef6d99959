// Recordings made and shown in the desktop: their files, marks and settings.
#include <atomic>
#include <fstream>

#include "core/dynamics/arm.h"
#include "tests/app/desktop/shell/a_desktop.h"
#include "tests/support/built_in.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

TEST_F(ADesktop, RecordsAndClosesTheFileBesideTheWindow) {
  for (int i = 0; i < 2; ++i) {
    record_something();
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return said("Recorded"); }));
    desktop->notices.clear();
  }
  ASSERT_EQ(recordings().size(), 2u);
  for (const fs::path& file : recordings()) EXPECT_GT(read_session(file).size(), 100u);
}

TEST_F(ADesktop, CompletesARecordingWhenItEnds) {
  record_something();
  desktop->drop_pictures();
  desktop.reset();
  ASSERT_EQ(recordings().size(), 1u);
  EXPECT_EQ(recordings()[0].extension(), ".h5");
  EXPECT_GT(read_session(recordings()[0]).size(), 100u);
}

TEST_F(ADesktop, LeavesNothingBehindWhenItEndsBeforeARecordingBegan) {
  desktop->world.toggle_recording();
  desktop->drop_pictures();
  desktop.reset();
  EXPECT_TRUE(recordings().empty());
}

// Rows of another width must not go into the file.
TEST_F(ADesktop, CompletesARecordingWhenADeviceBringsAnotherArm) {
  record_something();
  plug_in(2);
  EXPECT_TRUE(until([&] { return said("Recorded"); }));
  frames(20);
  ASSERT_EQ(recordings().size(), 1u);
  const Session session = read_session(recordings()[0]);
  EXPECT_EQ(session.layout.dof(), 3);
  EXPECT_GT(session.size(), 100u);
  for (std::size_t k = 0; k < session.size(); ++k) {
    ASSERT_NEAR(session.at(k, Column::time)[0], 1e-3 * static_cast<double>(k), 1e-9);
  }
}

TEST_F(ADesktop, SaysThatItCannotRecordAndGoesOn) {
  fs::remove_all(dir / "data");
  std::ofstream(dir / "data") << "a file where a folder should be";
  desktop->world.toggle_recording();
  EXPECT_TRUE(
      until([&] { return !desktop->notices.all().empty() && desktop->notices.all().back().bad; }));
  EXPECT_FALSE(desktop->live.recording());
  const auto ticks = loop().status().ticks;
  EXPECT_TRUE(until([&] { return loop().status().ticks > ticks + 50; }));
}

TEST_F(ADesktop, WritesBesideTheWindowAndSaysWhatBecameOfIt) {
  std::atomic<bool> elsewhere{false};
  desktop->live.save_beside([&, window = std::this_thread::get_id()] {
    elsewhere = std::this_thread::get_id() != window;
    return PlotNotice{"Saved a table"};
  });
  desktop->live.save_beside([] { return PlotNotice{"No room for a table", true}; });
  ASSERT_TRUE(until([&] { return said("No room for a table"); }));
  EXPECT_TRUE(said("Saved a table"));
  EXPECT_TRUE(elsewhere);
  EXPECT_TRUE(desktop->notices.all().back().bad);
}

TEST_F(ADesktop, OffersToPlayWhatItHasRecovered) {
  const fs::path sessions = dir / "data/limpid/sessions";
  fs::create_directories(sessions);
  const RunPlan plan = test::plan("table.toml", "touch.csv", 5);
  {
    // The recording is never finished.
    Recorder cut(sessions / "cut.h5", session_info(plan), Parameters{}, false);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return cut.push_waiting(row); });
  }
  ASSERT_TRUE(fs::exists(sessions / "cut.h5.part"));
  desktop->playback.recover_leftovers(sessions);
  EXPECT_EQ(desktop->playback.last(), sessions / "cut.h5");
  ASSERT_EQ(desktop->banners().size(), 1u);
  EXPECT_THAT(desktop->banners()[0].text, testing::HasSubstr("Recovered cut.h5"));
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  EXPECT_EQ(desktop->playback.shown()->file(), sessions / "cut.h5");
  EXPECT_TRUE(desktop->playback.recovered().empty()) << "it was played";
}

TEST_F(ADesktop, SaysThatALeftoverHasNothingToRecover) {
  const fs::path sessions = dir / "data/limpid/sessions";
  fs::create_directories(sessions);
  RunPlan plan;
  plan.arm = test::omni();
  plan.hand.source = "mouse";
  // The recording is never finished.
  { const Recorder cut(sessions / "cut.h5", session_info(plan), Parameters{}, false); }
  desktop->playback.recover_leftovers(sessions);
  EXPECT_TRUE(said("nothing was recorded"));
  EXPECT_FALSE(fs::exists(sessions / "cut.h5"));
}

TEST_F(ADesktop, MarksAChangeWhereItActsHoweverLongAFrameTakes) {
  frames(10);
  desktop->tuning.next_law();
  std::this_thread::sleep_for(250ms);  // a slow frame at high quality
  frames(20);
  const History& history = desktop->live.stage().history;
  const int kind = static_cast<int>(Channel::kind);
  SampleIndex first = history.end() - 1;
  const float now = history.value(kind, first);
  while (first > history.first() && history.value(kind, first - 1) == now) --first;
  ASSERT_FALSE(history.marks().empty());
  const PlotMark& mark = history.marks().back();
  EXPECT_EQ(mark.key, "coupling.kind");
  EXPECT_NEAR(mark.time, history.time(first), 0.05);
}

TEST_F(ADesktop, KeepsAMarkInTheRecordingAtTheTimeThatThePlotsShow) {
  record_something();
  frames(3);
  std::vector<double> shown;  // [s]
  const auto mark = [&] {
    std::this_thread::sleep_for(150ms);  // the loop is further than the plots
    const History& history = desktop->live.stage().history;
    shown.push_back(history.end_time() - history.offset());
    desktop->live.note(desktop->live.now(), "here");
    frames(5);
  };
  mark();
  mark();
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  const Session session = read_session(recordings()[0]);
  ASSERT_EQ(session.marks.size(), 2u);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double kept = session.at(session.marks[i].tick, Column::time)[0];
    EXPECT_NEAR(kept, shown[i], session.info.tick / 2);
  }
}

TEST_F(ADesktop, CountsTheMarksOfEachRecordingAnew) {
  const auto mark = [&] {
    desktop->marking.begin();
    std::string offered = desktop->marking.text();
    desktop->marking.accept(offered);
    frames(3);
    return offered;
  };
  EXPECT_EQ(mark(), "mark 1");
  for (int recording = 0; recording < 2; ++recording) {
    record_something();
    frames(3);
    EXPECT_EQ(mark(), "mark 1");
    EXPECT_EQ(mark(), "mark 2");
    desktop->world.toggle_recording();
    ASSERT_TRUE(until([&] { return said("Recorded"); }));
    desktop->notices.clear();
  }
  EXPECT_EQ(mark(), "mark 6") << "in the plots alone";
}

TEST_F(ADesktop, ShowsARecordingsOwnSettingsAtTheRowThatIsShown) {
  Settings& settings = desktop->settings;
  settings.parameters().kind = CouplingKind::proposed;
  settings.parameters().eta = 0.9;
  frames(3);
  record_something();
  settings.parameters().eta = 0.5;
  frames(20);
  settings.parameters().kind = CouplingKind::standard;
  frames(20);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  settings.parameters().eta = 0.2;
  settings.parameters().hand_stiffness = 99;
  frames(3);
  run("session.play");
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  PlayedSession& session = *desktop->playback.shown();
  Player& player = session.player();
  player.pause();
  const auto at = [&](double part) -> const Parameters& {
    player.seek(part * player.duration());
    return session.settings();
  };
  // Settings agree with the rows, forwards and backwards.
  for (const double part : {0.0, 0.3, 0.5, 0.7, 0.99, 0.5, 0.1, 0.8}) {
    const Parameters& then = at(part);
    const auto row = player.row();
    const RowLayout& layout = player.session().layout;
    EXPECT_EQ(static_cast<double>(then.kind), layout.in(row, Column::kind)[0]) << part;
    EXPECT_EQ(then.eta, layout.in(row, Column::eta)[0]) << part;
    EXPECT_EQ(then.hand_stiffness, Parameters{}.hand_stiffness);
  }
  EXPECT_EQ(at(0).eta, 0.9);
  EXPECT_EQ(at(0.99).kind, CouplingKind::standard);
  EXPECT_EQ(desktop->tuning.edited().eta, 0.9) << "the re-run begins as the recording did";
  frames(3);
  EXPECT_TRUE(desktop->tuning.analysis().above_eta_min) << "of the re-run";
  run("session.back_to_live");
  frames(3);
  EXPECT_EQ(desktop->tuning.edited().eta, 0.2);
  EXPECT_FALSE(desktop->tuning.analysis().above_eta_min) << "of the live loop again";
}

TEST_F(ADesktop, NamesTheRunsOfARecordedTwinAsTheyAreAtTheCursor) {
  run("session.twin");
  desktop->settings.parameters().kind = CouplingKind::standard;
  desktop->settings.lanes.parameters[kTwinLane].kind = CouplingKind::tank;
  frames(20);
  record_something();
  desktop->settings.parameters().kind = CouplingKind::proposed;
  frames(30);
  desktop->world.toggle_recording();
  ASSERT_TRUE(until([&] { return said("Recorded"); }));
  desktop->playback.open(recordings().at(0));
  ASSERT_TRUE(until([&] { return desktop->playback.on(); }));
  PlayedSession& played = *desktop->playback.shown();
  const auto laws_at = [&](double time) {
    played.player().seek(time);
    frames(1);
    return played.stage().names().laws;
  };
  using enum CouplingKind;
  const int second = static_cast<int>(tank);
  EXPECT_EQ(laws_at(0), (std::vector{static_cast<int>(standard), second}));
  EXPECT_EQ(laws_at(played.player().duration()), (std::vector{static_cast<int>(proposed), second}));
  EXPECT_EQ(laws_at(0), (std::vector{static_cast<int>(standard), second}));
}

}  // namespace
}  // namespace limpid
