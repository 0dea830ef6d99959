// Losses and paths by readings of encoders with steps, against what truly happened.
#include "core/coupling/cells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_arm.h"
#include "tests/support/tick.h"

namespace limpid {
namespace {

using test::Random;
using test::T;
using Any = Vec<kAnyDof>;

Any rounded_to(const Any& x, double q) { return (x / q).array().round().matrix() * q; }

TEST(SureLoss, IsWhatEvenMotionLosesWhereReadingsAreExact) {
  const Any b{{0.01, 0.02}}, dy{{2e-3, -3e-3}};
  EXPECT_NEAR(sure_loss<kAnyDof>(b, dy, 0, T), (0.01 * 4e-6 + 0.02 * 9e-6) / T, 1e-18);
}

TEST(SureLoss, IsNeverMoreThanTheLossOfAnyMotionWithTheseReadings) {
  Random random(5);
  for (const double q : {1e-5, 4.19e-4, 3e-3}) {
    Any x = random.vector(3, 1);
    const Any b = random.vector(3, 0.02).cwiseAbs();
    for (int k = 0; k < 2000; ++k) {
      const Any next = x + random.vector(3, k % 2 == 0 ? 2 * q : 5e-3);
      const Any dy = rounded_to(next, q) - rounded_to(x, q);
      ASSERT_LE(sure_loss<kAnyDof>(b, dy, q, T), b.dot((next - x).cwiseAbs2()) / T + 1e-18);
      x = next;
    }
  }
}

TEST(WithinCells, StaysInTheCellOfTheReading) {
  Random random(6);
  constexpr double q = 1e-3;
  for (int k = 0; k < 500; ++k) {
    const Any y = rounded_to(random.vector(4, 1), q), dy = rounded_to(random.vector(4, 3 * q), q);
    const Any z = within_cells<kAnyDof>(y, -dy / 2, q);
    ASSERT_LE((z - y).cwiseAbs().maxCoeff(), q / 2 * (1 + 1e-12));
    ASSERT_EQ(within_cells<kAnyDof>(y, -dy / 2, 0), y);
  }
}

// A spring on the readings is drawn slowly by a whole number of cells. Its work along the path is
// what it stores; along the readings half a k q^2 more for each cell.
TEST(WithinCells, KeepsTheWorkOfASpringOnSteps) {
  constexpr double q = 1e-3, k = 10;
  constexpr int kCells = 40, kTicksInACell = 25;
  Any y = Any::Zero(1), z = y;
  double along_path = 0, along_readings = 0;
  for (int i = 1; i <= kCells * kTicksInACell; ++i) {
    const Any next = rounded_to(Any::Constant(1, q * i / kTicksInACell), q);
    const Any to = within_cells<kAnyDof>(next, (y - next) / 2, q);
    const double torque = k * y[0];  // held over the tick
    along_path += torque * (to - z)[0];
    along_readings += torque * (next - y)[0];
    y = next;
    z = to;
  }
  const double stored = k / 2 * (kCells * q) * (kCells * q);
  EXPECT_NEAR(along_path, stored, 0.5 * k * q * q);
  EXPECT_NEAR(along_readings, stored - kCells * k * q * q / 2, 0.5 * k * q * q);
}

}  // namespace
}  // namespace limpid
