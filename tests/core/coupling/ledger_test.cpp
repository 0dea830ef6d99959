// The account of energy against sums written down once more.
#include "core/coupling/ledger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;
using Any = Vec<kAnyDof>;

constexpr double T = 0.001;
constexpr double kCap = 0.02;  // [J]

class LedgerOfJoints : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    y_ = random_.vector(n(), 1);
    b_lo_ = random_.vector(n(), 0.01).cwiseAbs();
    ledger_.start(y_);
  }
  int n() const { return GetParam(); }
  Random random_{41};
  Ledger<kAnyDof> ledger_;
  Any y_, b_lo_;
};
INSTANTIATE_TEST_SUITE_P(Joints, LedgerOfJoints, testing::Values(1, 3, 7));

TEST_P(LedgerOfJoints, IsWhatCameInAndWasDissipatedLessWhatIsStored) {
  double wanted = 0.004, stored = 0.002;
  ledger_.settle(0.004, stored);
  EXPECT_DOUBLE_EQ(ledger_.reserve(), wanted);  // whatever is stored at first is nobody's debt
  for (int k = 0; k < 200; ++k) {
    const Any next = y_ + random_.vector(n(), 1e-3), tau = random_.vector(n(), 0.1);
    ledger_.add(next, y_, tau, b_lo_, 0, T);
    for (int i = 0; i < n(); ++i) {
      const double dy = next[i] - y_[i];
      wanted += -tau[i] * dy + b_lo_[i] * dy * dy / T;
    }
    y_ = next;
    const double now = random_.between(0, 0.003);
    wanted -= now - stored;
    stored = now;
    ledger_.settle(0.004, stored);
    wanted = std::min(wanted, kCap);  // more than that is not kept
    ASSERT_NEAR(ledger_.reserve(), wanted, 1e-14);
  }
}

TEST_P(LedgerOfJoints, KeepsNoMoreThanItsCapAndSpendsFromThere) {
  ledger_.settle(0.005, 0);
  const Any tau = Any::Constant(n(), -1 / static_cast<double>(n()));
  const Any none = Any::Zero(n());
  ledger_.add(y_ + Any::Constant(n(), 1), y_, tau, none, 0, T);  // 1 J comes in
  ledger_.settle(0.005, 0);
  EXPECT_NEAR(ledger_.reserve(), kCap, 1e-16);
  ledger_.add(y_ + Any::Constant(n(), 1 - 0.005), y_, tau, none, 0, T);  // 5 mJ go out
  ledger_.settle(0.005, 0);
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.005, 1e-15);
  ledger_.settle(0.005, 0.001);
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.006, 1e-15);
  ledger_.settle(0.005, 0);  // what was stored comes back
  EXPECT_NEAR(ledger_.reserve(), kCap - 0.005, 1e-15);
}

TEST_P(LedgerOfJoints, OfAnEncoderCountsAStepOverAllTheTicksThatItTook) {
  constexpr double q = 1e-3;
  const Any tau = Any::Zero(n());
  ledger_.settle(0, 0);
  double wanted = 0;
  std::vector<int> since(static_cast<std::size_t>(n()), 0);
  for (int k = 0; k < 300; ++k) {
    Any next = y_;
    for (int i = 0; i < n(); ++i) {
      int& ticks = since[static_cast<std::size_t>(i)];
      ++ticks;
      if (random_.between(0, 1) > 0.2) continue;
      const double steps = random_.between(0, 1) < 0.5 ? 1 : -1;
      next[i] += steps * q;
      const double dy = next[i] - y_[i];
      wanted += b_lo_[i] * (dy / (ticks * T)) * (dy / (ticks * T)) * (ticks * T);
      ticks = 0;
    }
    ledger_.add(next, next, tau, b_lo_, q, T);
    y_ = next;
    ledger_.settle(0, 0);
    ASSERT_NEAR(ledger_.reserve(), wanted, 1e-12 * kCap);
    if (wanted > 0.5 * kCap) break;
  }
  EXPECT_GT(wanted, 0);
}

TEST_P(LedgerOfJoints, CountsTheWorkAlongAPathWithinTheCellsOfTheReadings) {
  constexpr double q = 1e-3;
  const Any none = Any::Zero(n());
  ledger_.settle(0, 0);
  double wanted = 0;
  Any before = y_;
  for (int k = 0; k < 300; ++k) {
    const Any next = y_ + q * random_.vector(n(), 3).array().round().matrix();
    const Any x = next + random_.vector(n(), 2 * q), tau = random_.vector(n(), 0.1);
    Any path = x;
    for (int i = 0; i < n(); ++i) path[i] = std::clamp(x[i], next[i] - q / 2, next[i] + q / 2);
    ledger_.add(next, x, tau, none, q, T);
    ASSERT_LE((ledger_.dx() - (path - before)).cwiseAbs().maxCoeff(), 1e-15);
    wanted -= tau.dot(path - before);
    ledger_.settle(0, 0);
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
  ledger_.add(next, y_, Any::Zero(n()), Any::Zero(n()), 0, T);
  const double dy = (next - y_).norm();
  const double leak = f2.norm() * (2 * slip.norm() + T * (0.1 * dy / T + 0.5));
  ledger_.settle(0, 0.005 - 0.3 * leak);
  ledger_.govern(f2, slip, T);
  EXPECT_NEAR(ledger_.contact(), 0.3, 1e-11);
  ledger_.settle(0, 0.005 - 0.2 * leak);
  ledger_.govern(f2, slip, T);
  EXPECT_NEAR(ledger_.contact(), 0.2, 1e-11);
  ledger_.settle(0, 0.005 + 0.2 * leak);
  ledger_.govern(f2, slip, T);
  EXPECT_EQ(ledger_.contact(), 0);  // nothing left to give
  for (int k = 1; k <= 150; ++k) {
    ledger_.settle(0, 0);
    ledger_.govern(Any::Zero(n()), slip, T);  // without a force nothing leaks
    ASSERT_NEAR(ledger_.contact(), 1 - std::pow(1 - T / 0.05, k), 1e-12);
  }
}

TEST_P(LedgerOfJoints, CutsTheDampingBelowFourMillijoulesAndGivesItBackIn200) {
  const Any none = Any::Zero(n());
  ledger_.settle(0.005, 0);
  const auto with = [&](double reserve) {
    ledger_.settle(0, 0.005 - reserve);
    ledger_.govern(none, none, T);
    return ledger_.damping();
  };
  EXPECT_EQ(with(0.005), 1);
  EXPECT_NEAR(with(0.004), 1, 1e-12);
  EXPECT_NEAR(with(0.0025), 0.5, 1e-12);
  EXPECT_NEAR(with(0.0013), 0.1, 1e-12);
  EXPECT_EQ(with(0.001), 0);
  EXPECT_EQ(with(-0.001), 0);
  for (int k = 1; k <= 400; ++k) {
    ASSERT_NEAR(with(0.005), 1 - std::pow(1 - T / 0.2, k), 1e-12);
  }
}

TEST_P(LedgerOfJoints, StartsAnew) {
  ledger_.settle(0.005, 0.001);
  ledger_.add(y_ + Any::Constant(n(), 0.5), y_, Any::Constant(n(), 1), Any::Zero(n()), 1e-3, T);
  ledger_.settle(0.005, 0.3);
  ledger_.govern(Any::Constant(n(), 1), Any::Constant(n(), 1), T);
  EXPECT_LT(ledger_.reserve(), 0);
  EXPECT_EQ(ledger_.contact(), 0);
  ledger_.start(y_);
  ledger_.settle(0.003, 0.7);
  EXPECT_NEAR(ledger_.reserve(), 0.003, 1e-15);
  EXPECT_EQ(ledger_.contact(), 1);
  EXPECT_EQ(ledger_.damping(), 1);
  EXPECT_EQ(ledger_.dx(), Any::Zero(n()));
}

}  // namespace
}  // namespace limpid
