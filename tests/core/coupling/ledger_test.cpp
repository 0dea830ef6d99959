// The account of energy against sums written out independently.
#include "core/coupling/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using Any = Vec<kAnyDof>;

using test::T;
constexpr double kE0 = 0.005, kCap = 4 * kE0;  // [J]

class LedgerOfJoints : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    y_ = random_.vector(n(), 1);
    b_lo_ = random_.vector(n(), 0.01).cwiseAbs();
    ledger_.start(y_, std::nullopt, Owed::nothing);
  }
  // Adds a tick under the torque `tau`, which was also sent for it.
  void add(const Any& y, const Any& x, const Any& tau, const Any& b_lo, double q) {
    ledger_.add(
        y, x, [&](int) { return tau; }, b_lo, 0, q, T);
  }
  int n() const { return GetParam(); }
  Random random_{41};
  Ledger<kAnyDof> ledger_;
  Any y_, b_lo_;
};
INSTANTIATE_TEST_SUITE_P(Joints, LedgerOfJoints, testing::Values(1, 3, 7));

TEST_P(LedgerOfJoints, IsWhatCameInAndWasDissipatedLessWhatIsStored) {
  double wanted = kE0, stored = 0.002;
  ledger_.settle(kE0, stored);
  EXPECT_DOUBLE_EQ(ledger_.reserve(), wanted);  // the initially stored energy is nobody's debt
  for (int k = 0; k < 200; ++k) {
    const Any next = y_ + random_.vector(n(), 1e-3), tau = random_.vector(n(), 0.1);
    add(next, y_, tau, b_lo_, 0);
    for (int i = 0; i < n(); ++i) {
      const double dy = next[i] - y_[i];
      wanted += -tau[i] * dy + b_lo_[i] * dy * dy / T;
    }
    y_ = next;
    const double now = random_.between(0, 0.003);
    wanted -= now - stored;
    stored = now;
    ledger_.settle(kE0, stored);
    wanted = std::min(wanted, kCap);  // the cap
    ASSERT_NEAR(ledger_.reserve(), wanted, 1e-14);
  }
}

TEST_P(LedgerOfJoints, KeepsNoMoreThanItsCapAndSpendsFromThere) {
  ledger_.settle(0.005, 0);
  const Any tau = Any::Constant(n(), -1 / static_cast<double>(n()));
  const Any none = Any::Zero(n());
  add(y_ + Any::Constant(n(), 1), y_, tau, none, 0);  // 1 J comes in
  ledger_.settle(0.005, 0);
  EXPECT_NEAR(ledger_.reserve(), kCap, 1e-16);
  add(y_ + Any::Constant(n(), 1 - 0.005), y_, tau, none, 0);  // 5 mJ go out
  ledger_.settle(0.005, 0);
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.005, 1e-15);
  ledger_.settle(0.005, 0.001);
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.006, 1e-15);
  ledger_.settle(0.005, 0);  // what was stored comes back
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.005, 1e-15);
}

TEST_P(LedgerOfJoints, OfAnEncoderCreditsOnlyMotionThatTheStepDoesNotExplain) {
  constexpr double q = 1e-3;
  const Any tau = Any::Zero(n());
  ledger_.settle(kE0, 0);
  double wanted = kE0;
  for (int k = 0; k < 300 && wanted < 0.9 * kCap; ++k) {
    Any next = y_;
    for (int i = 0; i < n(); ++i) {
      const double steps = std::round(random_.between(-3, 3));
      next[i] += steps * q;
      const double v = std::max(0.0, std::abs(steps) - 1) * q / T;
      wanted += b_lo_[i] * v * v * T;
    }
    add(next, next, tau, b_lo_, q);
    y_ = next;
    ledger_.settle(kE0, 0);
    ASSERT_NEAR(ledger_.reserve(), wanted, 1e-12 * kCap);
  }
  EXPECT_GT(wanted, kE0);
}

// A reading that goes to and fro across an edge may come from no motion worth the name.
TEST_P(LedgerOfJoints, OfAnEncoderCreditsNothingAtAnEdge) {
  constexpr double q = 1e-3;
  ledger_.settle(kE0, 0);
  for (int k = 0; k < 300; ++k) {
    const Any next = y_ + Any::Constant(n(), k % 2 == 0 ? q : 0);
    add(next, next, Any::Zero(n()), b_lo_, q);
    ledger_.settle(kE0, 0);
  }
  EXPECT_NEAR(ledger_.reserve(), kE0, 1e-15);
}

TEST_P(LedgerOfJoints, CountsTheWorkAlongAPathWithinTheCellsOfTheReadings) {
  constexpr double q = 1e-3;
  const Any none = Any::Zero(n());
  ledger_.settle(kE0, 0);
  double wanted = kE0;
  Any before = y_;
  for (int k = 0; k < 300; ++k) {
    const Any next = y_ + q * random_.vector(n(), 3).array().round().matrix();
    const Any x = next + random_.vector(n(), 2 * q), tau = random_.vector(n(), 0.1);
    Any path = x;
    for (int i = 0; i < n(); ++i) path[i] = std::clamp(x[i], next[i] - q / 2, next[i] + q / 2);
    add(next, x, tau, none, q);
    ASSERT_LE((ledger_.dx() - (path - before)).cwiseAbs().maxCoeff(), 1e-15);
    wanted -= tau.dot(path - before);
    ledger_.settle(kE0, 0);
    wanted = std::min(wanted, kCap);
    ASSERT_NEAR(ledger_.reserve(), wanted, 1e-14);
    y_ = next;
    before = path;
  }
}

TEST_P(LedgerOfJoints, CutsTheContactForceAtOnceAndGivesItBackIn50Milliseconds) {
  ledger_.settle(0.005, 0);
  const Any f2 = random_.vector(n(), 1), slip = random_.vector(n(), 1e-3);
  const Any next = y_ + random_.vector(n(), 1e-3);
  add(next, y_, Any::Zero(n()), Any::Zero(n()), 0);
  double leak = T * 0.5 * f2.norm();
  for (int i = 0; i < n(); ++i) {
    leak += std::abs(f2[i]) * (2 * std::abs(slip[i]) + 0.1 * std::abs(next[i] - y_[i]));
  }
  ledger_.settle(kE0, kE0 - 0.3 * leak);
  ledger_.govern(f2, slip, 0.5, T);
  EXPECT_NEAR(ledger_.contact(), 0.3, 1e-11);
  ledger_.settle(kE0, kE0 - 0.2 * leak);
  ledger_.govern(f2, slip, 0.5, T);
  EXPECT_NEAR(ledger_.contact(), 0.2, 1e-11);
  ledger_.settle(kE0, kE0 + 0.2 * leak);
  ledger_.govern(f2, slip, 0.5, T);
  EXPECT_EQ(ledger_.contact(), 0);  // nothing left to give
  for (int k = 1; k <= 150; ++k) {
    ledger_.settle(kE0, 0);
    ledger_.govern(Any::Zero(n()), slip, 0.5, T);  // without a force nothing leaks
    ASSERT_NEAR(ledger_.contact(), 1 - std::pow(1 - T / 0.05, k), 1e-12);
  }
}

TEST_P(LedgerOfJoints, CutsTheDampingAndGivesItBackIn200Milliseconds) {
  const Any none = Any::Zero(n());
  ledger_.settle(kE0, 0);
  const auto with = [&](double share) {  // `share` of E0 is left
    ledger_.settle(kE0, (1 - share) * kE0);
    ledger_.govern(none, none, 0.5, T);
    return ledger_.damping();
  };
  EXPECT_EQ(with(1), 1);
  EXPECT_NEAR(with(0.8), 1, 1e-12);
  EXPECT_NEAR(with(0.575), 0.5, 1e-12);
  EXPECT_NEAR(with(0.395), 0.1, 1e-12);
  EXPECT_NEAR(with(0.35), 0, 1e-12);
  EXPECT_EQ(with(-0.2), 0);
  EXPECT_EQ(ledger_.torque(), 1);  // stored energy was not given
  for (int k = 1; k <= 400; ++k) ASSERT_NEAR(with(1), 1 - std::pow(1 - T / 0.2, k), 1e-12);
}

TEST_P(LedgerOfJoints, CutsAllTorqueByWhatWasGivenAndByWhatIsOnItsWay) {
  constexpr int kMost = 3;
  const Any none = Any::Zero(n()), dx = random_.vector(n(), 1e-3);
  std::vector<Any> sent(kMost + 1, none);
  ledger_.expect(0, kMost);
  ledger_.settle(kE0, 0);
  Any y = y_;
  double wanted = 1, least = kE0;
  std::vector<double> accounts(kMost + 1, kE0);
  bool part = false;
  for (int k = 0; k < 40; ++k) {
    sent.insert(sent.begin(), 2e-4 / dx.squaredNorm() * (k % 7 == 0 ? -0.3 : 1.0) * dx);
    y += dx;
    ledger_.add(
        y, y, [&](int d) { return sent[static_cast<std::size_t>(d)]; }, none, 0, 0, T);
    double coming = 0;
    least = kCap;
    for (std::size_t d = 0; d <= kMost; ++d) {
      accounts[d] -= sent[d].dot(dx);
      least = std::min(least, accounts[d]);
      if (d < kMost) coming += std::max(0.0, sent[d].dot(dx));
    }
    const double target = std::clamp(((least - coming) / kE0 - 0.25) / (0.35 - 0.25), 0.0, 1.0);
    wanted = target < wanted ? target : wanted + T / 0.2 * (target - wanted);
    // Energy that the hand stores in a wall takes no torque away.
    ledger_.settle(kE0, 0.3 * k * kE0);
    ledger_.govern(none, none, 0.5, T);
    ASSERT_NEAR(ledger_.torque(), wanted, 1e-9) << k;
    part = part || (wanted > 0.1 && wanted < 0.9);
  }
  EXPECT_TRUE(part);
  EXPECT_EQ(ledger_.torque(), 0);
}

// After half a second within half a milliradian 5 mJ are forgiven, up to a balance of 2 mJ.
TEST_P(LedgerOfJoints, ForgivesWhatAHandThatHoldsStillSeemsToOwe) {
  const Any none = Any::Zero(n());
  const auto tick = [&](const Any& y) {
    add(y, y, none, none, 0);
    ledger_.settle(kE0, 0.03);
    ledger_.forgive_at_rest(0, T);
    return ledger_.reserve();
  };
  ledger_.settle(kE0, 0);
  const Any off = Any::Constant(n(), 4e-4);
  for (int k = 0; k < 498; ++k) {
    ASSERT_NEAR(tick(k % 2 == 0 ? y_ : Any(y_ + off)), -0.025, 1e-15) << k;
  }
  for (const double left : {-0.02, -0.015, -0.01, -0.005, 0.0, 0.002}) {
    for (int k = 0; k < 500; ++k) tick(y_);
    ASSERT_NEAR(ledger_.reserve(), left, 1e-15);
  }
  for (int k = 0; k < 2000; ++k) ASSERT_NEAR(tick(y_), 0.002, 1e-15) << "and no more than that";
}

TEST_P(LedgerOfJoints, ForgivesNothingWhileTheDeviceMoves) {
  const Any none = Any::Zero(n());
  ledger_.settle(kE0, 0);
  for (int k = 0; k < 3000; ++k) {
    Any y = y_;
    y[n() - 1] += 0.01 * std::sin(0.05 * k);
    add(y, y, none, none, 0);
    ledger_.settle(kE0, 0.03);
    ledger_.forgive_at_rest(0, T);
    ASSERT_NEAR(ledger_.reserve(), -0.025, 1e-15) << k;
  }
}

// A torque that acts d ticks late does the work of the tick in which it acts. The account of the
// true delay is right, and the lowest account counts.
TEST_P(LedgerOfJoints, CountsTheLeastOfTheAccountsOfEveryDelayThatIsPossible) {
  constexpr int kLeast = 1, kMost = 4;
  std::vector<Any> sent(kMost + 1, Any::Zero(n()));  // the newest first
  std::vector<double> wanted(kMost + 1, kE0);
  ledger_.expect(kLeast, kMost);
  ledger_.settle(kE0, 0);
  bool other = false;
  for (int k = 0; k < 300; ++k) {
    sent.insert(sent.begin(), random_.vector(n(), 0.2));
    const Any next = y_ + random_.vector(n(), 1e-3);
    ledger_.add(
        next, next, [&](int d) { return sent[static_cast<std::size_t>(d)]; }, Any::Zero(n()), 0, 0,
        T);
    ledger_.settle(kE0, 0);
    double least = kCap;
    for (std::size_t d = kLeast; d <= kMost; ++d) {
      wanted[d] = std::min(kCap, wanted[d] - sent[d].dot(next - y_));
      least = std::min(least, wanted[d]);
    }
    ASSERT_NEAR(ledger_.reserve(), least, 1e-14);
    other = other || least != wanted[kLeast];
    y_ = next;
  }
  EXPECT_TRUE(other);
  const double left = ledger_.reserve();
  ledger_.expect(0, 6);  // delays that are possible only now start from the same balance
  ledger_.settle(kE0, 0);
  EXPECT_EQ(ledger_.reserve(), left);
}

TEST_P(LedgerOfJoints, StartsAnewWithNoMoreThanIsLeft) {
  ledger_.settle(kE0, 0.001);
  add(y_ + Any::Constant(n(), 0.5), y_, Any::Constant(n(), 1), Any::Zero(n()), 1e-3);
  ledger_.settle(kE0, 0.3);
  ledger_.govern(Any::Constant(n(), 1), Any::Constant(n(), 1), 0.5, T);
  EXPECT_LT(ledger_.reserve(), 0);
  EXPECT_EQ(ledger_.contact(), 0);
  const double left = ledger_.reserve();
  ledger_.start(y_, std::nullopt, Owed::nothing);
  ledger_.start(y_, std::nullopt, Owed::nothing);  // a second start before any use
  ledger_.settle(0.003, 0.7);
  EXPECT_EQ(ledger_.reserve(), left);
  EXPECT_EQ(ledger_.contact(), 1);
  EXPECT_EQ(ledger_.damping(), 1);
  EXPECT_EQ(ledger_.torque(), 1);
  EXPECT_EQ(ledger_.dx(), Any::Zero(n()));
  ledger_.start(y_, 0.002, Owed::nothing);  // the balance of a recording
  ledger_.settle(0.003, 0.7);
  EXPECT_EQ(ledger_.reserve(), 0.002);
  ledger_.start(y_, 1.0, Owed::nothing);
  ledger_.settle(0.003, 0.7);
  EXPECT_EQ(ledger_.reserve(), 0.003);
  ledger_.start(y_, std::numeric_limits<double>::infinity(), Owed::nothing);  // a new loop
  ledger_.settle(0.003, 0.7);
  EXPECT_EQ(ledger_.reserve(), 0.003);
}

// A stall, in which the hand may have gone deeper into a wall that did not push.
TEST_P(LedgerOfJoints, OwesWhatWasStoredWhileNobodyLooked) {
  ledger_.settle(kE0, 0.010);
  ledger_.start(y_, std::nullopt, Owed::growth);
  ledger_.settle(kE0, 0.012);
  EXPECT_NEAR(ledger_.reserve(), kE0 - 0.002, 1e-14);
  ledger_.start(y_, std::nullopt, Owed::growth);
  ledger_.settle(kE0, 0.001);
  EXPECT_NEAR(ledger_.reserve(), kE0 - 0.002, 1e-14) << "what was lost is no gain";
}

// An open hand switch, a trip: no motor pushes against a hand that goes into a wall. What the wall
// stores is owed until the hand has left it.
TEST_P(LedgerOfJoints, OwesWhatIsStoredWithoutForceAlsoWhenForceIsArmed) {
  const Any none = Any::Zero(n());
  ledger_.settle(kE0, 0);
  for (const double stored : {0.03, 0.5, 0.0, 0.02}) {
    y_ += random_.vector(n(), 1e-3);
    add(y_, y_, none, none, 0);
    ledger_.settle(kE0, stored);
    ASSERT_NEAR(ledger_.reserve(), kE0 - stored, 1e-14) << stored;
  }
  const Any tau = Any::Constant(n(), 1 / static_cast<double>(n()));
  y_ += Any::Constant(n(), 0.001);  // a torque that was still on its way gives 1 mJ
  add(y_, y_, tau, none, 0);
  ledger_.settle(kE0, 0.02);
  EXPECT_NEAR(ledger_.reserve(), kE0 - 0.021, 1e-14);
  ledger_.refill();
  EXPECT_NEAR(ledger_.reserve(), kE0 - 0.02, 1e-14);
  ledger_.settle(kE0, 0);
  EXPECT_NEAR(ledger_.reserve(), kE0, 1e-14) << "out of the wall";
}

TEST_P(LedgerOfJoints, OwesWhatIsStoredAtAStartUntilItIsStoredNoMore) {
  ledger_.start(y_, std::nullopt, Owed::all);
  ledger_.settle(kE0, 3.6);
  EXPECT_NEAR(ledger_.reserve(), kE0 - 3.6, 1e-14);
  ledger_.settle(kE0, 0);  // nothing of it went to the hand
  EXPECT_NEAR(ledger_.reserve(), kE0, 1e-14);
}

// A loop that starts over knows nothing of its first reading, as after a stall.
TEST_P(LedgerOfJoints, OwesAllThatIsStoredWhereAStallFollowsTheStart) {
  ledger_.settle(kE0, 3.6);
  ledger_.start(y_, std::nullopt, Owed::all);
  ledger_.start(y_, std::nullopt, Owed::growth);
  ledger_.settle(kE0, 3.6);
  EXPECT_NEAR(ledger_.reserve(), kE0 - 3.6, 1e-14);
}

}  // namespace
}  // namespace limpid
