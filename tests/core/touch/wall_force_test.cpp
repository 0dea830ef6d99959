// A wall's force over a tick against the balance of energy that defines it.
#include "core/touch/wall_force.h"

#include <gtest/gtest.h>

#include "tests/support/random_arm.h"

namespace limpid {
namespace {

using test::Random;

double spread(Random& random, double low, double high) {
  return std::exp(random.between(std::log(low), std::log(high)));
}

// A random tick: from soft to far stiffer than a tick can follow, from light to heavy.
WallTick some_tick(Random& random) {
  WallTick w{};
  w.K = spread(random, 1, 1e5);
  w.B = random.between(0, 1) < 0.3 ? 0 : spread(random, 1e-3, 1e3);
  w.T = spread(random, 1e-4, 1e-2);
  w.c = spread(random, 1e-9, 1e-2);
  const double size = spread(random, 1e-7, 1e-2);
  w.d = size * random.between(-1, 1);
  w.a = size * random.between(-1, 1) * spread(random, 0.1, 10);
  return w;
}

struct Balance {
  double given;  // F D less the energy to spring and damper [J]
  double size;   // of the terms [J]
};

Balance balance(const WallTick& w, double F) {
  const double D = w.a - w.c * F;
  const double before = std::max(w.d, 0.0), after = std::max(w.d + D, 0.0);
  const double stored = 0.5 * w.K * (after * after - before * before);
  const double damped = w.B / w.T * D * (after - before);
  const double way = std::abs(w.a) + w.c * F + std::abs(w.d);
  return {F * D - stored - damped, F * way + (w.K + w.B / w.T) * way * way};
}

enum WallCase { kStays, kBreaks, kMakes, kApart, kCases };

WallCase case_of(const WallTick& w, double F) {
  const double end = w.d + w.a - w.c * F;
  if (w.d >= 0) return end >= 0 ? kStays : kBreaks;
  return end > 0 ? kMakes : kApart;
}

TEST(WallForce, DoesTheWorkThatTheSpringLosesAndTheDamperTakesInAllCases) {
  Random random(11);
  std::array<int, kCases> pushed{}, met{};
  for (int round = 0; round < 400000; ++round) {
    const WallTick w = some_tick(random);
    const double F = wall_force(w);
    ASSERT_TRUE(F >= 0) << "it pulls: " << F;
    const WallCase now = case_of(w, F);
    ++met[now];
    const Balance b = balance(w, F);
    if (F > 0) {
      ++pushed[now];
      ASSERT_LT(std::abs(b.given), 1e-14 * b.size)
          << now << ": d " << w.d << " a " << w.a << " c " << w.c << " K " << w.K << " B " << w.B;
    } else {
      // The contact opens as the damper would hold it: the spring's remaining energy is lost.
      ASSERT_LE(b.given, 1e-14 * b.size) << now;
    }
  }
  EXPECT_GT(pushed[kStays], 10000);
  EXPECT_GT(pushed[kBreaks], 10000);
  EXPECT_GT(pushed[kMakes], 10000);
  EXPECT_GT(met[kApart], 10000);
  EXPECT_EQ(pushed[kApart], 0);
}

TEST(WallForce, WithoutADamperLosesNothingEvenWhereItLetsGo) {
  Random random(12);
  for (int round = 0; round < 100000; ++round) {
    WallTick w = some_tick(random);
    w.B = 0;
    const Balance b = balance(w, wall_force(w));
    ASSERT_LT(std::abs(b.given), 1e-14 * b.size);
  }
}

TEST(WallForce, PushesOnlyWhatIsInOrWouldCome) {
  Random random(13);
  for (int round = 0; round < 100000; ++round) {
    WallTick w = some_tick(random);
    w.d = -std::abs(w.d);
    w.a = std::min(w.a, -w.d);
    ASSERT_EQ(wall_force(w), 0);
    w.a = -w.d * random.between(1.001, 10);
    ASSERT_GT(wall_force(w), 0);
    w.d = -w.d;
    w.B = 0;
    w.a = random.between(-10, 10) * w.d;
    ASSERT_GT(wall_force(w), 0);
  }
}

// Along a line of depths and motions, follows the largest jump of the force into ever smaller
// parts.
double largest_jump(const WallTick& from, const WallTick& to) {
  const auto at = [&](double s) {
    WallTick w = from;
    w.d = from.d + s * (to.d - from.d);
    w.a = from.a + s * (to.a - from.a);
    return wall_force(w);
  };
  double low = 0, high = 1, jump = 0;
  for (int round = 0; round < 20; ++round) {
    constexpr int kParts = 8;
    double first = at(low), next_low = low, width = (high - low) / kParts;
    jump = -1;
    for (int i = 0; i < kParts; ++i) {
      const double second = at(low + (i + 1) * width);
      if (std::abs(second - first) > jump) {
        jump = std::abs(second - first);
        next_low = low + i * width;
      }
      first = second;
    }
    low = next_low;
    high = low + width;
    if (width < 1e-9) break;
  }
  return jump;
}

TEST(WallForce, NeverJumpsAcrossTheBordersOfItsCases) {
  Random random(14);
  for (int round = 0; round < 20000; ++round) {
    const WallTick from = some_tick(random);
    WallTick to = from;
    to.d = std::abs(from.d) * random.between(-2, 2);
    to.a = std::abs(from.a) * random.between(-2, 2);
    const double way = std::abs(from.d) + std::abs(from.a) + std::abs(to.d) + std::abs(to.a);
    // The force is never steeper than an explicit spring and damper and a stop that answers at
    // once, 1/c.
    const double steepest = std::min(from.K + from.B / from.T, 1 / from.c) * way;
    ASSERT_LT(largest_jump(from, to), 1e-6 * steepest);
  }
}

// The inverse: the force from the change of depth that it caused.
TEST(WallPush, IsTheSameForceWhereTheChangeOfDepthIsKnown) {
  Random random(16);
  std::array<int, kCases> met{};
  for (int round = 0; round < 100000; ++round) {
    WallTick w = some_tick(random);
    w.T = 1e-3;
    w.B = std::min(w.B, 0.2 * w.T / w.c);  // bounded: the damper pushes back no more than its share
    const double F = wall_force(w), D = w.a - w.c * F;
    ++met[case_of(w, F)];
    WallTick known = w;
    known.a = D;
    const double size = w.K * (std::abs(w.d) + std::abs(D)) + w.B / w.T * std::abs(D);
    // D is a difference of numbers that may be much larger.
    const double lost = 1e-13 * (std::abs(w.a) + w.c * F) * (w.K + w.B / w.T);
    ASSERT_NEAR(wall_push(known).force, F, 1e-7 * size + lost) << round;
  }
  for (const int count : met) EXPECT_GT(count, 1000);
}

TEST(WallPush, AnswersTheChangeOfDepthAsItsSlopeSays) {
  Random random(17);
  int looked_at = 0;
  for (int round = 0; round < 20000; ++round) {
    WallTick w = some_tick(random);
    w.T = 1e-3;
    const double h = 1e-6 * (std::abs(w.a) + std::abs(w.d)), D = w.a;
    const auto at = [&](double change) {
      WallTick there = w;
      there.a = D + change;
      return wall_push(there).force;
    };
    const double slope = wall_push(w).slope;
    const double fine = (at(h) - at(-h)) / (2 * h), coarse = (at(2 * h) - at(-2 * h)) / (4 * h);
    if (std::abs(fine - coarse) > 1e-4 * (1 + std::abs(fine))) continue;  // a corner lies between
    ++looked_at;
    ASSERT_NEAR(slope, fine, 2e-3 * (1 + std::abs(fine))) << round;
  }
  EXPECT_GT(looked_at, 15000);
}

TEST(WallForce, OfWhatNoForceMovesIsTheMeanOfSpringAndDamper) {
  Random random(15);
  for (int round = 0; round < 100000; ++round) {
    WallTick w = some_tick(random);
    w.c = 1e-6 * spread(random, 1e-14, 1) / (w.K + w.B / w.T);
    const double end = w.d + w.a;
    const double before = std::max(w.d, 0.0), after = std::max(end, 0.0);
    // The mean over the part of the way that is inside.
    const double b = w.B / w.T;
    const double mean =
        (0.5 * w.K * (after * after - before * before) + b * w.a * (after - before)) / w.a;
    const double size = w.K * (before + after) + b * (std::abs(w.a));
    ASSERT_NEAR(wall_force(w), std::max(0.0, mean), 1e-5 * size)
        << "d " << w.d << " a " << w.a << " c " << w.c << " K " << w.K << " B " << w.B;
  }
}

}  // namespace
}  // namespace limpid
