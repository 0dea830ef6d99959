// Re-runs: the recorded hand again, under what was changed.
#include "app/run/rerun.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/app/run/recorded.h"
#include "tests/devices/files/test_files.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

class ARerun : public testing::Test {
 protected:
  const test::TempDir dir_;
  const Session session_ = test::recorded(test::plan("table.toml", "touch.csv", 2), dir_ / "a.h5");
  const Parameters before_ = session_parameters(session_, "a.h5");
};

TEST_F(ARerun, NamesItsChangesAndTakesThemAgain) {
  EXPECT_TRUE(changed_settings(session_, "a.h5", before_).empty());
  Parameters chosen = before_;
  set_parameter(chosen, "coupling.kind", std::string("standard"));
  chosen.eta = 1.0 / 3;
  chosen.damping = 0.02;
  const auto changes = changed_settings(session_, "a.h5", chosen);
  EXPECT_EQ(changes.size(), 3u);
  EXPECT_EQ(with_changes(session_, "a.h5", changes), chosen);
  EXPECT_ANY_THROW(with_changes(session_, "a.h5", {"coupling.etta=1"}));
}

TEST_F(ARerun, HasTheRowsOfTheRecordingUntilSomethingIsChanged) {
  const std::atomic<bool> stop = false;
  double part = 0;
  const auto at = [&](double now) { part = now; };
  const RerunRows same = run_once_more(session_, "a.h5", before_, stop, at);
  ASSERT_EQ(same.rows.size(), session_.rows.size());
  const auto device = session_.layout.offset(Column::device_position);
  const auto last = same.rows.size() - static_cast<std::size_t>(session_.layout.stride());
  const auto of_last = last + static_cast<std::size_t>(device);
  EXPECT_EQ(same.rows[of_last], session_.rows[of_last]);
  EXPECT_EQ(part, 1);
  EXPECT_EQ(same.name, "re-run: as recorded");
  Parameters chosen = before_;
  set_parameter(chosen, "coupling.kind", std::string("standard"));
  const RerunRows other = run_once_more(session_, "a.h5", chosen, stop, at);
  EXPECT_NE(other.rows[of_last], session_.rows[of_last]);
  EXPECT_EQ(other.name, "re-run: standard");
  EXPECT_EQ(other.recorded, std::string("recorded: ") + name(before_.kind));
  const std::atomic<bool> stopped = true;
  EXPECT_TRUE(run_once_more(session_, "a.h5", chosen, stopped, at).rows.empty());
}

// Below eta_min the proposed law gives energy, and does not yet become unstable in this hand.
TEST_F(ARerun, SaysThatItIsNotPassive) {
  const std::atomic<bool> stop = false;
  Parameters chosen = before_;
  set_parameter(chosen, "coupling.kind", std::string("proposed"));
  chosen.eta = 0.3;
  const RerunRows given = run_once_more(session_, "a.h5", chosen, stop, [](double) {});
  ASSERT_FALSE(given.end.diverged);
  EXPECT_THAT(given.cautions, testing::ElementsAre(testing::HasSubstr("not passive")));
  EXPECT_THAT(run_once_more(session_, "a.h5", before_, stop, [](double) {}).cautions,
              testing::IsEmpty());
}

// A motor is at its limit whenever it gives all of its torque.
TEST_F(ARerun, SaysForHowLongMotorsAreAtTheirLimit) {
  const std::atomic<bool> stop = false;
  Parameters chosen = before_;
  set_parameter(chosen, "coupling.kind", std::string("standard"));
  chosen.torque_limit = 0.03;
  const RerunRows weak = run_once_more(session_, "a.h5", chosen, stop, [](double) {});
  ASSERT_EQ(weak.settings.size(), 1u);
  EXPECT_EQ(weak.settings[0].parameters, chosen);
  std::size_t limited = 0;
  const auto stride = static_cast<std::size_t>(session_.layout.stride());
  for (std::size_t at = 0; at < weak.rows.size(); at += stride) {
    const std::span<const double> row = std::span(weak.rows).subspan(at, stride);
    const auto torque = session_.layout.in(row, Column::motor_torque);
    limited += std::ranges::any_of(torque, [](double t) { return std::abs(t) >= 0.03; }) ? 1 : 0;
  }
  EXPECT_GT(limited, 0u);
  EXPECT_NEAR(weak.at_limit, 1e-3 * static_cast<double>(limited), 1e-9);
  EXPECT_EQ(run_once_more(session_, "a.h5", before_, stop, [](double) {}).at_limit, 0);
}

}  // namespace
}  // namespace limpid
