#include "app/session/energy_account.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/test_session.h"

namespace limpid {
namespace {

// What the window would show of a run, sample by sample.
struct Books {
  TraceChannels channels{RowLayout(3)};
  History history{{.channels = TraceChannels(RowLayout(3)).count(), .seconds = 60}};
  EnergyAccount account;
  int ticks = 0;

  // For so many ticks E_c goes evenly to `energy` [J].
  void go_to(double energy, int count, bool limited = false) {
    const double from = account.total();
    for (int i = 1; i <= count; ++i) {
      std::vector<double> values(static_cast<std::size_t>(channels.count()), 0.0);
      values[static_cast<std::size_t>(Channel::energy_total)] = from + (energy - from) * i / count;
      values[static_cast<std::size_t>(Channel::limited)] = limited ? 1 : 0;
      history.append(0.001 * ticks++, values);
      account.follow(history, history.end());
    }
  }
  void change(const char* key) { history.mark(0.001 * (ticks - 1), key, key); }
};

constexpr double kRound = 1e-6;  // the history is in single precision

TEST(EnergyAccount, CallsWhatNobodyElsePutInTheCouplingsOwn) {
  Books books;
  books.go_to(-0.05, 100);
  books.go_to(0.02, 500);
  EXPECT_NEAR(books.account.own(), 0.02, kRound);
  EXPECT_EQ(books.account.by_changes(), 0);
}

TEST(EnergyAccount, BooksWhatASwitchPutsInAsTheSwitchs) {
  Books books;
  books.go_to(-0.1, 100);
  books.change("coupling.kind");
  books.go_to(0.19, 50);
  books.go_to(0.18, 2000);
  EXPECT_NEAR(books.account.by_changes(), 0.29, kRound);
  EXPECT_NEAR(books.account.own(), -0.11, kRound);
}

TEST(EnergyAccount, JudgesTheCouplingAgainOnceASwitchHasSettled) {
  Books books;
  books.go_to(0, 10);
  books.change("coupling.eta");
  books.go_to(0, static_cast<int>(1000 * EnergyAccount::kSettling) + 10);
  books.go_to(0.05, 500);
  EXPECT_NEAR(books.account.own(), 0.05, kRound);
}

TEST(EnergyAccount, ForgivesWithAChangeWhatTheSettingBeforeItGave) {
  Books books;
  books.go_to(0.4, 500);
  EXPECT_NEAR(books.account.own(), 0.4, kRound);
  books.change("coupling.kind");
  books.go_to(0.4, 1000);
  EXPECT_NEAR(books.account.own(), 0, kRound);
  EXPECT_NEAR(books.account.by_changes(), 0, kRound) << "but the switch did not put it in";
  books.go_to(0.45, 100);
  EXPECT_NEAR(books.account.own(), 0.05, kRound);
}

TEST(EnergyAccount, GivesNoCreditForWhatASwitchTookAway) {
  Books books;
  books.change("coupling.kind");
  books.go_to(-0.2, 50);
  books.go_to(-0.05, 50);  // still settling, and back below where it began
  EXPECT_EQ(books.account.by_changes(), 0);
  EXPECT_NEAR(books.account.own(), -0.05, kRound);
}

TEST(EnergyAccount, TakesARecordingsBeginForNoChange) {
  Books books;
  books.go_to(0, 10);
  books.change("rec");
  books.go_to(0.05, 100);
  EXPECT_NEAR(books.account.own(), 0.05, kRound);
}

TEST(EnergyAccount, BooksWhatIsGainedAtTheMotorsLimitApart) {
  Books books;
  books.go_to(-0.1, 100);
  books.go_to(-0.15, 100, true);  // pressed in
  books.go_to(-0.1, 100, true);   // and let out again: nothing gained
  EXPECT_NEAR(books.account.by_limits(), 0, kRound);
  books.go_to(-0.04, 100, true);
  books.go_to(-0.04, 100);
  EXPECT_NEAR(books.account.by_limits(), 0.06, kRound);
  EXPECT_NEAR(books.account.own(), -0.1, kRound);
}

TEST(EnergyAccount, StartsOverWithTheLoop) {
  Books books;
  books.go_to(0, 10);
  books.change("coupling.kind");
  books.go_to(0.3, 100);
  books.ticks = 0;
  std::vector<double> at_rest(static_cast<std::size_t>(books.channels.count()), 0.0);
  books.history.append(0, at_rest);
  books.account.follow(books.history, books.history.end());
  EXPECT_EQ(books.account.total(), 0);
  EXPECT_EQ(books.account.by_changes(), 0);
}

TEST(EnergyAccount, IsTheSameAtAMomentWhetherPlayedOrJumpedTo) {
  Books books;
  books.go_to(-0.1, 100);
  books.change("coupling.kind");
  books.go_to(0.2, 100);
  books.go_to(0.1, 100);
  EnergyAccount there;
  there.follow(books.history, 150);
  EnergyAccount back;
  back.follow(books.history, books.history.end());
  back.follow(books.history, 150);
  EXPECT_EQ(back.own(), there.own());
  EXPECT_EQ(back.by_changes(), there.by_changes());
}

// The real loop: every law to every other while it presses onto the table, then on to the end of
// the path, off the table.
TEST(EnergyAccount, FindsNoFaultInAnyLawThatIsSwitchedToWhilePressing) {
  const RunPlan whole = test::plan("table.toml", "touch.csv", 12);
  for (std::uint8_t from = 0; from < kLaws; ++from) {
    for (std::uint8_t to = 0; to < kLaws; ++to) {
      if (to == from) continue;
      RunPlan plan = whole;
      plan.parameters.kind = static_cast<CouplingKind>(from);
      TraceChannels channels(RowLayout(3));
      channels.set_limits(motor_limits(plan.arm, plan.parameters));
      History history({.channels = channels.count(), .seconds = 20});
      std::uint64_t hardest = 0;
      double most = 0;
      simulate(plan, {}, [&, k = std::uint64_t{0}](std::span<const double> row, auto*) mutable {
        const auto f2 = channels.layout().in(row, Column::contact_torque);
        const double contact = std::hypot(f2[0], f2[1], f2[2]);
        if (contact > most) {
          most = contact;
          hardest = k;
        }
        ++k;
        return true;
      });
      ASSERT_GT(most, 0.05) << "it presses";
      plan.changes = {
          {hardest, std::string("coupling.kind = \"") + name(static_cast<CouplingKind>(to)) + '"'}};
      double worst = -1;
      EnergyAccount account;
      simulate(plan, {}, [&](std::span<const double> row, const Parameters* changed) {
        const double time = channels.layout().in(row, Column::time)[0];
        if (changed != nullptr) history.mark(time - plan.parameters.tick, "", "coupling.kind");
        channels.append(history, row);
        account.follow(history, history.end());
        worst = std::max(worst, account.own());
        return true;
      });
      EXPECT_LT(worst, 1e-3) << name(static_cast<CouplingKind>(from)) << " to "
                             << name(static_cast<CouplingKind>(to));
    }
  }
}

}  // namespace
}  // namespace limpid
