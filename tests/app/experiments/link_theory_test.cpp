#include "app/experiments/link_theory.h"

#include <gtest/gtest.h>

#include <array>

#include "app/experiments/tap_bench.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

constexpr double kGrip[] = {300};  // [N/m]

// (b_d + b_v + k_vc T/2 + b_h r^2) over (T/2 + b_v/k_vc + the trip), r the lever of the tip.
TEST(LinkTheory, OfThePapersLawIsItsDampingAgainstTheWholeTrip) {
  const TipAlong tip = tip_at_table(built_in_arm());
  const double b = (0.012 + 0.012 + 10 * 0.001 / 2) / tip.lever2 + TapBench::kGripDamping;
  const LinkTheory theory(built_in_arm(), kGrip[0]);
  for (const int delay : {0, 1, 2}) {
    const double wall = b / (0.001 / 2 + 0.012 / 10 + 2 * delay * 0.001);
    ASSERT_GT(wall, kSoftest);
    EXPECT_NEAR(theory.proposed(delay), wall, 1e-6 * wall) << delay;
  }
  EXPECT_EQ(theory.proposed(100), kSoftest) << "where not even the spring is stable";
}

// Taps that are simulated rest, or do not rest on any wall, as theory says.
TEST(LinkTheory, OfTheStandardLawSaysWhereTapsComeToRest) {
  const test::TempDir temp;
  TrialRunner::Options options;
  options.dir = temp / ".";
  TrialRunner lab("walls", options);
  const LinkTheory theory(built_in_arm(), kGrip[0]);
  EXPECT_EQ(theory.standard(0), kStiffest);
  EXPECT_EQ(theory.standard(100), kSoftest);
  const auto rests = [](const Touch& touch, bool) {
    return touch.energy <= 5e-3 && touch.moving <= 5e-3;
  };
  for (const auto& [delay, stable] :
       {std::pair(2, true), std::pair(10, false), std::pair(13, false), std::pair(25, false)}) {
    const TapSetting late{.kind = CouplingKind::standard, .link = delay, .hold = 6};
    const double found = stiffest_walls(lab, std::array{late}, {kGrip, rests}).front();
    EXPECT_EQ(found > kSoftest, stable) << delay;
    EXPECT_EQ(theory.standard(delay) > kSoftest, stable) << delay;
  }
}

}  // namespace
}  // namespace limpid
