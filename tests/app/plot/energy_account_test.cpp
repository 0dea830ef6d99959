#include <gtest/gtest.h>

#include <vector>

#include "app/plot/trace_channels.h"
#include "tests/support/test_session.h"

namespace limpid {
namespace {

// The history of a run and its account, as the window shows them, sample by sample.
struct Books {
  TraceChannels channels{RowLayout(3)};
  History history{{.channels = TraceChannels(RowLayout(3)).count(), .seconds = 60}};
  EnergyAccount account;
  int ticks = 0;

  // Moves E_c evenly to `energy` [J] in so many ticks.
  void go_to(double energy, int count, bool limited = false) {
    const double from = account.total();
    for (int i = 1; i <= count; ++i) {
      std::vector<double> values(static_cast<std::size_t>(channels.count()), 0.0);
      values[static_cast<std::size_t>(Channel::energy_total)] = from + (energy - from) * i / count;
      values[static_cast<std::size_t>(Channel::limited)] = limited ? 1 : 0;
      history.append(0.001 * ticks++, values);
      account.follow(history, history.end(), channels.lane(kMainLane));
    }
  }
  void change(const char* key) { history.mark(0.001 * (ticks - 1), key, key); }
};

constexpr double kRound = 1e-6;  // the history has single precision

TEST(EnergyAccount, CallsWhatNobodyElsePutInTheCouplingsOwn) {
  Books books;
  books.go_to(-0.05, 100);
  books.go_to(0.02, 500);
  EXPECT_NEAR(books.account.own(), 0.02, kRound);
  EXPECT_EQ(books.account.by_changes(), 0);
}

// Energy goes to a device whose weight the motors lift, not to the hand.
TEST(EnergyAccount, LeavesOutWhatWasForTheDevicesOwnForces) {
  Books books;
  for (int i = 1; i <= 500; ++i) {
    std::vector<double> values(static_cast<std::size_t>(books.channels.count()), 0.0);
    values[static_cast<std::size_t>(Channel::energy_total)] = 1e-3 * i;
    values[static_cast<std::size_t>(Channel::energy_compensation)] = 1.1e-3 * i;
    books.history.append(0.001 * i, values);
    books.account.follow(books.history, books.history.end(), books.channels.lane(kMainLane));
  }
  EXPECT_NEAR(books.account.own(), -0.05, kRound);
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
  books.go_to(0, static_cast<int>(1000 * EnergyShares::kSettling) + 10);
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
  books.go_to(-0.05, 50);  // still settling, back below its beginning
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

// The parts of E_c, of every origin, add up.
TEST(EnergyAccount, AddsUpToAllThatWasGiven) {
  Books books;
  books.go_to(0.2, 100);
  books.change("coupling.kind");
  books.go_to(0.5, 100);
  books.go_to(0.45, 1000);
  books.go_to(0.6, 100, true);
  books.go_to(0.55, 100);
  const EnergyAccount& a = books.account;
  EXPECT_NEAR(a.own() + a.by_changes() + a.by_limits() + a.forgiven(), a.total(), kRound);
  EXPECT_NEAR(a.total(), 0.55, kRound);
  EXPECT_NEAR(a.forgiven(), 0.2, kRound);
}

// Each lane has its own account: a change in one does not excuse another.
TEST(EnergyAccount, OfAFurtherLaneIsItsOwn) {
  const TraceChannels channels{RowLayout(3)};
  const int one = channels.count();
  History history({.channels = 3 * one, .seconds = 10});
  EnergyAccount first, second, third;
  const auto go_on = [&](int from, int to, double of_second) {
    for (int k = from; k < to; ++k) {
      std::vector<double> values(static_cast<std::size_t>(3 * one), 0.0);
      values[static_cast<std::size_t>(Channel::energy_total)] = -1e-4 * k;
      for (const int lane : {1, 2}) {
        values[static_cast<std::size_t>(lane * one) +
               static_cast<std::size_t>(Channel::energy_total)] = of_second;
      }
      history.append(1e-3 * k, values);
    }
    first.follow(history, history.end(), channels.lane(kMainLane));
    second.follow(history, history.end(), channels.lane(kTwinLane));
    third.follow(history, history.end(), channels.lane(2));
  };
  go_on(0, 100, std::nan(""));
  go_on(100, 200, 0);
  history.mark(0.199, "eta 1", "coupling.eta");  // changes the first run only
  go_on(200, 300, 0.3);
  EXPECT_NEAR(first.own(), -0.0299, kRound);
  EXPECT_NEAR(second.own(), 0.3, kRound);
  EXPECT_EQ(second.by_changes(), 0);
  history.mark(0.299, "twin: eta 1", lane_mark(kTwinLane) + "coupling.eta");
  go_on(300, 400, 0.5);
  EXPECT_NEAR(second.by_changes(), 0.2, kRound);
  EXPECT_EQ(first.by_changes(), 0);
  EXPECT_EQ(third.by_changes(), 0);
  EXPECT_NEAR(third.own(), 0.5, kRound);
  history.mark(0.399, "grip", "hand.stiffness");  // changes all runs
  go_on(400, 450, 0.6);
  EXPECT_NEAR(second.by_changes(), 0.3, kRound);
  EXPECT_NEAR(third.by_changes(), 0.1, kRound);
}

TEST(EnergyAccount, BooksWhatIsGainedAtTheMotorsLimitApart) {
  Books books;
  books.go_to(-0.1, 100);
  books.go_to(-0.15, 100, true);  // pressed in
  books.go_to(-0.1, 100, true);   // and released: no gain
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
  books.account.follow(books.history, books.history.end(), books.channels.lane(kMainLane));
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
  there.follow(books.history, 150, books.channels.lane(kMainLane));
  EnergyAccount back;
  back.follow(books.history, books.history.end(), books.channels.lane(kMainLane));
  back.follow(books.history, 150, books.channels.lane(kMainLane));
  EXPECT_EQ(back.own(), there.own());
  EXPECT_EQ(back.by_changes(), there.by_changes());
}

// A plan whose hand goes down through the table, stays there for a while and comes up again,
// pressing hard.
RunPlan pressing() {
  RunPlan plan = test::plan("table.toml", "touch.csv", 5);
  const Vec3 top = plan.hand.position.front();
  plan.hand =
      parse_hand_csv(fmt::format("time_s,x_m,y_m,z_m\n0,{0},{1},{2}\n1,{0},{1},{3}\n4,{0},{1},{3}\n"
                                 "4.5,{0},{1},{2}\n6,{0},{1},{2}\n",
                                 top.x(), top.y(), top.z(), top.z() - 0.09),
                     "pressed hard");
  return plan;
}

// The real loop switches from every law to every other one while it presses on the table, then
// leaves it.
TEST(EnergyAccount, FindsNoFaultInAnyLawThatIsSwitchedToWhilePressing) {
  const RunPlan whole = pressing();
  double most_given = 0;  // including the switches' energy
  for (std::uint8_t from = 0; from < kLaws; ++from) {
    for (std::uint8_t to = 0; to < kLaws; ++to) {
      if (to == from) continue;
      RunPlan plan = whole;
      plan.parameters.kind = static_cast<CouplingKind>(from);
      TraceChannels channels(RowLayout(3));
      channels.set_limits(motor_limits(plan.arm, plan.parameters));
      History history({.channels = channels.count(), .seconds = 20});
      plan.changes = {
          {2000, std::string("coupling.kind = \"") + name(static_cast<CouplingKind>(to)) + '"'}};
      double worst = -1;
      EnergyAccount account;
      simulate(plan, {}, [&](std::span<const double> row, LaneChanges changed) {
        const double time = channels.layout().in(row, Column::time)[0];
        if (changed[0] != nullptr) history.mark(time - plan.parameters.tick, "", "coupling.kind");
        channels.append(history, row);
        account.follow(history, history.end(), channels.lane(kMainLane));
        // The predictive law's promise concerns its ledger, not E_c.
        const auto kind = static_cast<CouplingKind>(channels.layout().in(row, Column::kind)[0]);
        if (!info(kind).keeps_ledger()) worst = std::max(worst, account.own());
        most_given = std::max(most_given, account.total());
        return true;
      });
      EXPECT_LT(worst, 1e-3) << name(static_cast<CouplingKind>(from)) << " to "
                             << name(static_cast<CouplingKind>(to));
    }
  }
  EXPECT_GT(most_given, 1e-2) << "or there was nothing to tell apart";
}

}  // namespace
}  // namespace limpid
