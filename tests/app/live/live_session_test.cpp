// A live session without a window: its lanes, its rows, and what becomes of recordings.
#include "app/live/live_session.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "app/run/replay.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/built_in.h"
#include "tests/support/fake_device.h"
#include "tests/support/temp_dir.h"
#include "tests/support/until.h"

namespace limpid {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class ALiveSession : public testing::Test {
 protected:
  ALiveSession() {
    plan_.arm = test::omni();
    plan_.document = test::omni_document("table.toml");
    plan_.hand.source = "mouse";
    session_->open(plan_.arm, plan_.document.scene, plan_.parameters, Vec3(0.19, 0, 0));
  }

  // Turns until `done`.
  template <class Done>
  bool turn_until(Done done) {
    return test::until([&] {
      news_ = session_->turn([this](LaneRows rows, std::uint64_t tick) {
        ticks_.insert(tick);
        last_.clear();
        for (const auto& row : rows) last_.push_back(row[0]);
      });
      if (!news_.failure.empty()) failure_ = news_.failure;
      return done();
    });
  }
  bool some_ticks() {
    const std::size_t wanted = ticks_.size() + 30;
    return turn_until([&] { return ticks_.size() >= wanted; });
  }
  // The plan of all lanes that run.
  RunPlan recorded() {
    RunPlan plan = plan_;
    plan.parameters = session_->controls().parameters();
    for (const Parameters& p : session_->lanes().subspan(1)) plan.beside.push_back({p, {}});
    return plan;
  }
  void record(const fs::path& file) {
    const RunPlan plan = recorded();
    session_->record(session_info(plan), plan.settings(), file, false);
  }
  void run_three() {
    for (std::size_t i = 1; i < kMostLanes; ++i) {
      Parameters p;
      p.kind = i == 1 ? CouplingKind::standard : CouplingKind::predictive;
      p.hand_stiffness = 77;  // is the first lane's
      session_->set(i, p);
    }
    session_->run_lanes(kMostLanes);
  }

  test::TempDir dir_;
  RunPlan plan_;
  std::unique_ptr<LiveSession> session_ = std::make_unique<LiveSession>(AskForPriority{});
  RecordingNews news_;
  std::string failure_;
  std::set<std::uint64_t> ticks_;
  std::vector<double> last_;  // times of all lanes in the newest tick
};

TEST_F(ALiveSession, PassesOnEveryTickOfTheLanesThatRun) {
  EXPECT_FALSE(session_->ticked());
  ASSERT_EQ(session_->rows().size(), 1u) << "zeros before the first tick";
  ASSERT_TRUE(some_ticks());
  EXPECT_TRUE(session_->ticked());
  EXPECT_EQ(session_->tick(), *ticks_.rbegin());
  EXPECT_EQ(session_->rows().size(), 1u);
  run_three();
  ASSERT_TRUE(some_ticks());
  ASSERT_EQ(session_->rows().size(), kMostLanes);
  const RowLayout& layout = session_->loop().layout();
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    const auto row = session_->rows()[i];
    EXPECT_EQ(layout.in(row, Column::kind)[0], static_cast<double>(session_->lanes()[i].kind));
    EXPECT_EQ(session_->lanes()[i].hand_stiffness, Parameters{}.hand_stiffness);
  }
  EXPECT_EQ(last_[1], last_[2]) << "both began at one moment";
  session_->run_lanes(1);
  ASSERT_TRUE(some_ticks());
  EXPECT_EQ(session_->rows().size(), 1u);
  EXPECT_TRUE(std::isnan(last_[1]) && std::isnan(last_[2]));
}

// Lanes begin in the same turn as their recording, which waits for them, and they stay in it.
TEST_F(ALiveSession, RecordsLanesWholeThatComeAndGoMeanwhile) {
  ASSERT_TRUE(some_ticks());
  for (int again = 0; again < 5; ++again) {
    const fs::path file = dir_ / ("a" + std::to_string(again) + ".h5").c_str();
    run_three();
    record(file);
    ASSERT_TRUE(turn_until([this] { return news_.began; }));
    ASSERT_TRUE(some_ticks());
    session_->run_lanes(1);
    ASSERT_TRUE(some_ticks());
    session_->stop_recording();
    ASSERT_TRUE(turn_until([this] { return news_.complete; }));
    const Session session = read_session(file);
    ASSERT_EQ(session.lanes(), kMostLanes);
    EXPECT_GT(session.size(), 30u);
    EXPECT_EQ(session.size(), session_->last_recording().rows);
    ASSERT_TRUE(some_ticks());
  }
}

// A turn that waited for the disk would hold up the window, and the loop takes the force from a
// window that is silent.
TEST_F(ALiveSession, GoesOnWhileTheFileOfARecordingIsCompleted) {
  bool went_on = false;
  for (int again = 0; again < 5; ++again) {
    record(dir_ / ("a" + std::to_string(again) + ".h5").c_str());
    ASSERT_TRUE(turn_until([this] { return news_.began; }));
    ASSERT_TRUE(some_ticks());
    session_->stop_recording();
    ASSERT_TRUE(turn_until([&] {
      went_on = went_on || (news_.ended && !news_.complete);
      return news_.complete;
    }));
  }
  EXPECT_TRUE(went_on) << "each turn in which one ended waited for its file";
}

TEST_F(ALiveSession, RefusesSeveralLanesOfADevice) {
  session_->open(plan_.arm, plan_.document.scene, plan_.parameters,
                 std::make_unique<test::FakeDevice>(3));
  run_three();
  record(dir_ / "a.h5");
  turn_until([this] { return !failure_.empty(); });
  EXPECT_NE(failure_.find("several runs"), std::string::npos) << failure_;
  EXPECT_FALSE(session_->recording());
  EXPECT_EQ(session_->rows().size(), 1u);
}

TEST_F(ALiveSession, SaysWhyARecordingCannotBegin) {
  std::ofstream(dir_ / "a.h5") << "somebody's";
  record(dir_ / "a.h5");
  EXPECT_TRUE(session_->recording()) << "its world must not change while it is opened";
  ASSERT_TRUE(turn_until([this] { return !failure_.empty(); }));
  EXPECT_NE(failure_.find("a.h5"), std::string::npos);
  EXPECT_FALSE(session_->recording());
  EXPECT_EQ(session_->take_failure(), failure_);
  EXPECT_EQ(session_->take_failure(), "") << "once";
  record(dir_ / "b.h5");
  ASSERT_TRUE(turn_until([this] { return news_.began; }));
}

TEST_F(ALiveSession, LeavesNoFileOfARecordingThatNeverBegan) {
  record(dir_ / "a.h5");
  session_.reset();
  EXPECT_TRUE(fs::is_empty(dir_ / "."));
}

TEST_F(ALiveSession, CompletesARecordingAtItsEnd) {
  record(dir_ / "a.h5");
  ASSERT_TRUE(turn_until([this] { return news_.began; }));
  ASSERT_TRUE(some_ticks());
  session_.reset();
  EXPECT_GT(read_session(dir_ / "a.h5").size(), 20u);
}

// Nobody holds the arm of a new world, and time goes on as usual.
TEST_F(ALiveSession, BeginsAWorldAsIfNobodyWereThere) {
  ASSERT_TRUE(some_ticks());
  Controls& controls = session_->controls();
  controls.grab = controls.magnet = controls.paused = true;
  controls.pull.body = 3;
  controls.probe = 7;
  controls.slow = 10;
  controls.goal = Vec3(1, 2, 3);
  Parameters p;
  p.eta = 0.75;
  session_->open(plan_.arm, plan_.document.scene, p, Vec3(0.18, 0.01, 0));
  EXPECT_FALSE(controls.grab || controls.magnet || controls.paused);
  EXPECT_EQ(controls.pull, BodyPull{});
  EXPECT_EQ(controls.probe, 0u);
  EXPECT_EQ(controls.slow, 1);
  EXPECT_EQ(controls.goal, Vec3(0.18, 0.01, 0));
  EXPECT_EQ(controls.parameters().eta, 0.75);
  EXPECT_FALSE(session_->ticked());
  EXPECT_EQ(session_->tick(), 0u);
  ASSERT_EQ(session_->rows().size(), 1u);
  const std::span<const double> nothing = session_->rows()[0];
  EXPECT_TRUE(std::ranges::all_of(nothing, [](double number) { return number == 0; }));
  ASSERT_TRUE(turn_until([this] { return session_->tick() > 20; }));
  const std::span<const double> row = session_->rows()[0];
  EXPECT_EQ(session_->loop().layout().in(row, Column::eta)[0], 0.75);
  session_->open(plan_.arm, plan_.document.scene, p, std::make_unique<test::FakeDevice>(3));
  EXPECT_EQ(controls.goal, rest_tip(plan_.arm));
}

TEST_F(ALiveSession, ForgetsAPullInAnotherState) {
  session_->controls().pull = {1, Vec3(1, 0, 0), Vec3(0, 1, 0)};
  session_->touch(plan_.arm, plan_.document.scene);
  EXPECT_EQ(session_->controls().pull, BodyPull{}) << "bodies may have other numbers";
}

TEST_F(ALiveSession, TellsTheWholeStoryOfARecording) {
  record(dir_ / "a.h5");
  EXPECT_TRUE(session_->opening_recording() && session_->recording());
  EXPECT_FALSE(session_->closing());
  EXPECT_EQ(session_->last_recording().file, dir_ / "a.h5");
  bool began = false, ended = false;
  ASSERT_TRUE(turn_until([&] {
    began = began || news_.began;
    return began && session_->loop().recorder()->rows() > 30;
  }));
  EXPECT_FALSE(session_->opening_recording());
  EXPECT_TRUE(session_->recording());
  EXPECT_FALSE(session_->last_recording().complete);
  session_->stop_recording();
  EXPECT_FALSE(session_->recording());
  ASSERT_TRUE(turn_until([&] {
    ended = ended || news_.ended;
    return news_.complete;
  }));
  EXPECT_TRUE(ended);
  EXPECT_FALSE(session_->closing());
  const Recorded& last = session_->last_recording();
  EXPECT_EQ(last.file, dir_ / "a.h5");
  EXPECT_EQ(last.rows, read_session(dir_ / "a.h5").size());
  EXPECT_EQ(last.dropped, 0u);
  EXPECT_TRUE(last.complete);
  EXPECT_EQ(last.trouble + last.failure, "");
  const RunPlan plan = recorded();
  session_->record(
      std::make_unique<Recorder>(dir_ / "b.h5", session_info(plan), plan.settings(), false));
  EXPECT_EQ(session_->last_recording().file, dir_ / "b.h5");
  EXPECT_FALSE(session_->last_recording().complete) << "the last one's";
  ASSERT_TRUE(turn_until([&] { return session_->loop().recorder()->rows() > 10; }));
  session_->complete_recording();
  EXPECT_GT(read_session(dir_ / "b.h5").size(), 10u);
}

}  // namespace
}  // namespace limpid
