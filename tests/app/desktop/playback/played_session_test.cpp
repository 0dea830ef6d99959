// A second run with a recording's hand, shown beside the recording.
#include "app/desktop/playback/played_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/plot/trace_channels.h"
#include "app/run/recorder.h"
#include "app/run/replay.h"
#include "tests/support/temp_dir.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

class RunAgain : public testing::Test {
 protected:
  void SetUp() override {
    RunPlan plan = test::plan("free.toml", "free.csv", 1);
    plan.parameters.tick = 0.01;
    plan.rows = 400;
    Recorder recorder(file_, session_info(plan), plan.parameters, false);
    simulate(plan, {},
             [&](std::span<const double> row, LaneChanges) { return recorder.push_waiting(row); });
    recorder.finish();
    session_ = read_session(file_);
    chosen_ = session_parameters(session_, "a.h5");
  }
  Rerun run() { return run_again(session_, "a.h5", chosen_, progress_); }

  test::TempDir dir_;
  const std::filesystem::path file_ = dir_ / "a.h5";
  Session session_;
  Parameters chosen_;
  TaskProgress progress_;
};

TEST_F(RunAgain, UnderTheSameSettingsIsTheSame) {
  const Rerun again = run();
  EXPECT_FALSE(again.run.end.diverged);
  ASSERT_EQ(again.run.rows.size(), session_.rows.size());
  const auto stride = static_cast<std::size_t>(session_.layout.stride());
  test::Rows rows(session_.layout);
  for (std::size_t k = 0; k < session_.size(); ++k) {
    rows.add(std::span(again.run.rows).subspan(k * stride, stride));
  }
  EXPECT_EQ(test::first_difference(rows, test::rows_of(session_)), -1);
  EXPECT_EQ(again.history.end(), session_.size());
  EXPECT_EQ(progress_.part, 1);
}

TEST_F(RunAgain, HasFiguresToCompareItBy) {
  chosen_.k_vc = 20;
  const Rerun again = run();
  double error = 0, energy = -HUGE_VAL;
  const auto stride = static_cast<std::size_t>(session_.layout.stride());
  for (std::size_t k = 0; k < session_.size(); ++k) {
    const auto row = std::span<const double>(again.run.rows).subspan(k * stride, stride);
    const auto x1 = session_.layout.in(row, Column::device_position);
    const auto x2 = session_.layout.in(row, Column::proxy_position);
    double square = 0;
    for (std::size_t i = 0; i < x1.size(); ++i) square += (x1[i] - x2[i]) * (x1[i] - x2[i]);
    error = std::max(error, std::sqrt(square));
    energy = std::max(energy, session_.layout.in(row, Column::energy_total)[0]);
  }
  EXPECT_NEAR(again.run.figures.error, 1e3 * error, 1e-9);
  EXPECT_NEAR(again.run.figures.energy, energy, 1e-12);
  EXPECT_NE(again.run.recorded_figures.error, again.run.figures.error);
  chosen_ = session_parameters(session_, "a.h5");
  EXPECT_EQ(run().run.figures.error, again.run.recorded_figures.error) << "as recorded";
}

// The second run diverges long before its end: from then on it keeps its last row.
TEST_F(RunAgain, ThatDivergesHasItsLastRowToTheEnd) {
  chosen_.k_vc = 1e4;
  chosen_.torque_limit = 1e4;
  const Rerun again = run();
  ASSERT_TRUE(again.run.end.diverged);
  ASSERT_LT(again.run.end.rows, session_.size());
  ASSERT_EQ(again.run.rows.size(), session_.rows.size());
  const auto stride = static_cast<std::size_t>(session_.layout.stride());
  const auto row = [&](std::size_t k) {
    return std::span(again.run.rows).subspan(k * stride, stride);
  };
  const std::size_t last = again.run.end.rows - 1;
  EXPECT_EQ(session_.layout.in(row(last), Column::time)[0], 0.01 * static_cast<double>(last));
  for (std::size_t k = again.run.end.rows; k < session_.size(); ++k) {
    for (std::size_t i = 0; i < stride; ++i) {
      ASSERT_TRUE(row(k)[i] == row(last)[i] || (std::isnan(row(k)[i]) && std::isnan(row(last)[i])));
    }
  }
  // The plots hold both runs to the recording's end.
  EXPECT_EQ(again.history.end(), session_.size());
  EXPECT_EQ(again.history.channels(), 2 * TraceChannels(session_.layout).count());
}

TEST_F(RunAgain, ThatWasCancelledHasNoRows) {
  progress_.cancel = true;
  const Rerun again = run();
  EXPECT_TRUE(again.run.end.stopped);
  EXPECT_TRUE(again.run.rows.empty());
  EXPECT_EQ(again.history.channels(), TraceChannels(session_.layout).count());
}

// The plots have the channels of each of its runs once, and a row for each of its ticks.
TEST_F(RunAgain, HasAHistoryOfTheRunsThatWereRecorded) {
  const LoadedSession one = load_session(file_);
  const TraceChannels channels(one.arm, one.session->layout, one.session->info.bodies);
  EXPECT_EQ(one.history.channels(), channels.count());
  EXPECT_EQ(one.history.end() - one.history.lower_bound(-1), 400);
  const LoadedSession table = load_session(test::assets_dir() / "sessions/table.h5");
  EXPECT_EQ(table.history.channels() % static_cast<int>(table.session->lanes()), 0);
  EXPECT_NEAR(table.history.end_time(),
              static_cast<double>(table.session->size() - 1) * table.session->info.tick, 1e-6);
}

}  // namespace
}  // namespace limpid
