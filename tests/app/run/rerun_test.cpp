// Re-runs: the recorded hand again, under what was changed.
#include "app/run/rerun.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
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

// Largest |x_E| [mrad], largest |f2| [N m] and highest E_c [J] of rows.
std::array<double, 3> figures_in(const test::Rows& rows) {
  std::array<double, 3> most{};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Eigen::VectorXd error =
        rows.vec(k, Column::device_position) - rows.vec(k, Column::proxy_position);
    most[0] = std::max(most[0], 1e3 * error.norm());
    most[1] = std::max(most[1], rows.vec(k, Column::contact_torque).norm());
    most[2] = std::max(most[2], rows.at(k, Column::energy_total));
  }
  return most;
}

void expect_figures(const RunFigures& found, const test::Rows& rows) {
  const std::array<double, 3> wanted = figures_in(rows);
  EXPECT_NEAR(found.error, wanted[0], 1e-9 * wanted[0]);
  EXPECT_NEAR(found.contact, wanted[1], 1e-9 * wanted[1]);
  EXPECT_NEAR(found.energy, wanted[2], 1e-9);
  EXPECT_STREQ(found.error_unit, "mrad");
  EXPECT_STREQ(found.contact_unit, "N m");
}

TEST_F(ARerun, FollowsTheChangesOfTheRecordingAndHasTheFiguresOfBoth) {
  RunPlan plan = test::plan("table.toml", "touch.csv", 1.5);
  plan.changes = {{500, "coupling.kind = \"standard\""}, {800, "coupling.eta = 2.0"}};
  const Session session = test::recorded(plan, dir_ / "b.h5");
  const Parameters own = session_parameters(session, "b.h5");
  const std::atomic<bool> stop = false;
  std::vector<double> parts;
  const auto at = [&](double now) { parts.push_back(now); };
  const RerunRows same = run_once_more(session, "b.h5", own, stop, at);
  ASSERT_EQ(same.settings.size(), 3u);
  EXPECT_EQ(same.settings[0].row, 0u);
  EXPECT_EQ(same.settings[0].parameters, own);
  EXPECT_EQ(same.settings[1].row, 500u);
  EXPECT_EQ(same.settings[1].parameters.kind, CouplingKind::standard);
  EXPECT_EQ(same.settings[1].parameters.eta, own.eta);
  EXPECT_EQ(same.settings[2].row, 800u);
  EXPECT_EQ(same.settings[2].parameters.eta, 2);
  ASSERT_EQ(parts.size(), session.size());
  for (std::size_t k = 0; k < parts.size(); ++k) {
    ASSERT_NEAR(parts[k], static_cast<double>(k + 1) / static_cast<double>(parts.size()), 1e-12);
  }
  EXPECT_EQ(same.name, "re-run: as recorded");
  EXPECT_EQ(same.recorded, "recorded") << "one setting is not the name of all of it";
  EXPECT_EQ(same.figures.name, same.name);
  EXPECT_EQ(same.recorded_figures.name, same.recorded);
  EXPECT_EQ(same.note, "") << "this build recorded it";
  EXPECT_EQ(same.arm.name, plan.arm.name);
  EXPECT_EQ(same.end.rows, session.size());
  expect_figures(same.figures, test::rows_of(session));
  Parameters softer = own;
  softer.k_vc = 5;
  const RerunRows other = run_once_more(session, "b.h5", softer, stop, at);
  test::Rows rows(session.layout);
  rows.add(other.rows);
  ASSERT_EQ(rows.size(), session.size());
  EXPECT_GT(figures_in(rows)[0], figures_in(test::rows_of(session))[0]);
  expect_figures(other.figures, rows);
  expect_figures(other.recorded_figures, test::rows_of(session));
}

// A picture of both runs has as many rows of each.
TEST_F(ARerun, StandsStillFromWhereItBecameUnstable) {
  const std::atomic<bool> stop = false;
  Parameters wild = before_;
  set_parameter(wild, "coupling.kind", std::string("standard"));
  wild.k_vc = 1e5;
  wild.torque_limit = 1e4;
  const RerunRows again = run_once_more(session_, "a.h5", wild, stop, [](double) {});
  ASSERT_TRUE(again.end.diverged);
  ASSERT_LT(again.end.rows, session_.size());
  ASSERT_EQ(again.rows.size(), session_.rows.size());
  const auto stride = static_cast<std::size_t>(session_.layout.stride());
  const auto row = [&](std::size_t k) { return std::span(again.rows).subspan(k * stride, stride); };
  const std::size_t last = again.end.rows - 1;
  for (std::size_t k = last + 1; k < session_.size(); ++k) {
    ASSERT_TRUE(test::same_numbers(row(k), row(last))) << k;
  }
  EXPECT_FALSE(test::same_numbers(row(last), row(last - 1)));
}

}  // namespace
}  // namespace limpid
