// The bound of core/README.md, "Why no more is given", term by term: readings, estimates and
// torques are chosen against the account.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "core/coupling/ledger.h"
#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using test::T;
using Any = Vec<kAnyDof>;
constexpr double kReserve = 0.005;  // [J]

// Terms of the bound so far [J].
struct Terms {
  double given = 0;  // motors' work on the true path, less the least that the dampers took
  double spent = 0;  // E_0 - E of the account
  double cells = 0;  // q sum |dtau|, and the end

  double bound() const { return spent + cells; }
};

// A device whose true path, estimate and torque are anybody's choice.
class Adversary {
 public:
  Adversary(int n, unsigned seed, double q, int delay, const Any& b)
      : random_(seed), q_(q), delay_(delay), b_(b) {
    x_ = random_.vector(n, 1);
    acted_ = Any::Zero(n);
    ledger_.start(read(x_), std::nullopt, Owed::nothing);
    ledger_.expect(0, 3);
    ledger_.settle(kReserve, 0);
    sent_.assign(8, Any::Zero(n));
  }

  // A tick in which the true position goes to x while `tau` acts; the law locates it at `located`.
  void tick(const Any& x, const Any& tau, const Any& located) {
    const Any y = read(x);
    cells_ += q_ * (tau - acted_).lpNorm<1>();
    const Any way = x - x_;
    given_ += tau.dot(way) - b_.dot(way.cwiseAbs2()) / T;  // an even motion loses least
    // The torque that acts now was sent `delay` ticks ago; the other accounts see other ones.
    std::rotate(sent_.begin(), sent_.end() - 1, sent_.end());
    for (Any& each : sent_) each = random_.vector(static_cast<int>(x.size()), 0.1);
    sent_[static_cast<std::size_t>(delay_)] = tau;
    ledger_.add(
        y, located, [&](int d) -> const Any& { return sent_[static_cast<std::size_t>(d)]; }, b_, 0,
        q_, T);
    ledger_.settle(kReserve, 0);
    x_ = x;
    acted_ = tau;
  }

  Terms terms() const {
    return {given_, kReserve - ledger_.reserve(), cells_ + q_ * acted_.lpNorm<1>()};
  }
  Any read(const Any& x) const { return q_ > 0 ? Any((x / q_).array().round().matrix() * q_) : x; }
  const Any& x() const { return x_; }
  Random& random() { return random_; }

 private:
  Random random_;
  double q_;
  int delay_;
  Any b_, x_, acted_;
  Ledger<kAnyDof> ledger_;
  std::vector<Any> sent_;
  double given_ = 0, cells_ = 0;
};

TEST(LedgerBound, HoldsForAnyReadingsEstimatesAndTorques) {
  unsigned seed = 1;
  for (const int n : {1, 3, 7}) {
    for (const double q : {0.0, 1e-4, 4.19e-4, 3e-3}) {
      for (int delay = 0; delay <= 3; ++delay, ++seed) {
        Random draw(seed + 1000);
        const Any b = draw.vector(n, 0.02).cwiseAbs();
        Adversary one(n, seed, q, delay, b);
        for (int k = 0; k < 400; ++k) {
          const double way = k % 3 == 0 ? 2e-3 : 0.2 * q + 1e-5;
          const Any x = one.x() + one.random().vector(n, way);
          const Any located = one.read(x) + one.random().vector(n, 2 * q + 1e-6);
          one.tick(x, one.random().vector(n, 0.1), located);
          const Terms terms = one.terms();
          ASSERT_LE(terms.given, terms.bound() + 1e-12)
              << n << " joints, step " << q << ", delay " << delay << ", tick " << k;
        }
      }
    }
  }
}

// A path that goes to and fro within one cell while the torque goes with it: no reading ever
// changes, so the account sees nothing of it. The term of the cells covers it and is used in part.
TEST(LedgerBound, OfACellIsUsedByWhoeverPushesAlongWithWhatNobodySees) {
  constexpr double q = 4.19e-4;
  Adversary one(1, 5, q, 0, Any::Zero(1));
  const double middle = one.read(one.x())[0];
  double sign = 1;
  for (int k = 0; k < 1000; ++k, sign = -sign) {
    const Any x = Any::Constant(1, middle + sign * 0.499 * q);
    one.tick(x, Any::Constant(1, 0.1 * sign), Any::Constant(1, middle));
  }
  const Terms terms = one.terms();
  EXPECT_LE(terms.given, terms.bound());
  EXPECT_GT(terms.given, 0.45 * terms.cells) << "the bound is not idle";
  EXPECT_NEAR(terms.spent, 0, 1e-12) << "the account knows nothing of it";
}

// Exact encoders: what is given is what the account says, to round-off, but for the dampers' loss
// of which the account knows the least.
TEST(LedgerBound, IsExactWhereReadingsAre) {
  Adversary one(3, 9, 0, 2, Any::Zero(3));
  double given = 0;
  for (int k = 0; k < 300; ++k) {
    const Any x = one.x() + one.random().vector(3, 1e-4), tau = one.random().vector(3, 0.01);
    given += tau.dot(x - one.x());
    one.tick(x, tau, x);
    ASSERT_NEAR(one.terms().given, given, 1e-12);
    ASSERT_GE(one.terms().spent, given - 1e-12);
  }
}

}  // namespace
}  // namespace limpid
