#include <gtest/gtest.h>

#include <limits>

#include "app/experiments/tap_bench.h"
#include "app/run/analysis.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

constexpr Touch kGood{.energy = 0, .port = 0, .chatter = 0, .felt = 1};

TEST(WellRendered, AsksForEachOfItsPromises) {
  EXPECT_TRUE(well_rendered(kGood, true));
  Touch t = kGood;
  t.port = 6e-5;
  EXPECT_FALSE(well_rendered(t, true));
  t = kGood;
  t.chatter = 0.021;
  EXPECT_FALSE(well_rendered(t, true));
  for (const double felt : {0.94, 1.06, 0.0}) {
    t = kGood;
    t.felt = felt;
    EXPECT_FALSE(well_rendered(t, true)) << felt;
  }
  t = kGood;
  t.energy = 6e-5;
  EXPECT_FALSE(well_rendered(t, true));
  EXPECT_TRUE(well_rendered(t, false)) << "readings that jump cost nobody anything";
  t.energy = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(well_rendered(t, false));
}

TrialRunner::Options walls_in(const std::filesystem::path& dir) {
  TrialRunner::Options options;
  options.dir = dir;
  return options;
}

class Walls : public testing::Test {
 protected:
  bool renders(const TapSetting& setting, double wall) {
    for (const double grip : kGrips) {
      const TapBench bench(lab_.arm(), setting, wall, grip, 1);
      const TrialResult result = lab_.run({bench.trial()}).front();
      if (!well_rendered(bench.touch(result), setting.encoder_step == 0)) return false;
    }
    return true;
  }

  test::TempDir temp_;
  TrialRunner lab_{"walls", walls_in(temp_ / ".")};
};

TEST_F(Walls, OfThePapersLawEndWhereTheLagTakesMoreThanAllDampingGives) {
  // (b_d + b_v + k_vc T/2 + b_h r^2) over (T/2 + b_v/k_vc), r the lever of the tip.
  const TipAlong tip = tip_at_table(lab_.arm());
  const double b = (0.012 + 0.012 + 10 * 0.001 / 2) / tip.lever2 + TapBench::kGripDamping;
  const double theory = b / (0.001 / 2 + 0.012 / 10);
  const TapSetting paper{.kind = CouplingKind::proposed};
  const double found = stiffest_walls(lab_, std::array{paper}).front();
  EXPECT_GT(found, 0.5 * theory);
  EXPECT_LT(found, 1.5 * theory);
  EXPECT_TRUE(renders(paper, found));
  EXPECT_FALSE(renders(paper, 1.1 * found));
}

TEST_F(Walls, OfThePredictiveLawHaveNoEndHere) {
  EXPECT_EQ(stiffest_walls(lab_, std::array{TapSetting{}}).front(), kStiffest);
}

TEST_F(Walls, ThatAreSoftFeelSoft) {
  const TapBench bench(lab_.arm(), {}, 600, 300, 1);
  const Touch touch = bench.touch(lab_.run({bench.trial()}).front());
  EXPECT_NEAR(touch.felt, 1, 0.01);
  EXPECT_LT(touch.chatter, 1e-3);
}

// Fitted gains meet condition (3) through the link, b_d >= 2 b_vc + k_vc (T + t_l), and leave less
// of b_d than two digits of them round off.
TEST(TapBench, TapsThroughALinkWithGainsAsStiffAsConditionThreeAllows) {
  const ExperimentArm built_in = built_in_arm();
  const double b_d = 0.012;
  for (const int link : {1, 5, 20, 100}) {
    const TapSetting papers{.kind = CouplingKind::standard, .link = link};
    const Parameters plain = TapBench(built_in, papers, 600, 300, 1).parameters();
    EXPECT_EQ(plain.link_delay, link);
    EXPECT_EQ(plain.k_vc, Parameters{}.k_vc);
    EXPECT_FALSE(condition3(built_in.description, plain).holds) << link;
    TapSetting fits = papers;
    fits.fits_link = true;
    const Parameters fit = TapBench(built_in, fits, 600, 300, 1).parameters();
    EXPECT_EQ(fit.link_delay, link);
    EXPECT_EQ(fit.kind, CouplingKind::standard);
    const Condition3 condition = condition3(built_in.description, fit);
    EXPECT_TRUE(condition.holds) << link;
    EXPECT_LT(condition.device_margin, 0.1 * b_d) << link;
    EXPECT_NEAR(condition.device_margin, b_d - 2 * fit.b_vc - fit.k_vc * 0.001 * (1 + link), 1e-12)
        << link;
  }
}

TEST(TapBench, FindsATrialThatDivergedToBeAsBadAsCanBe) {
  const ExperimentArm built_in = built_in_arm();
  TrialResult result;
  result.end.diverged = true;
  const Touch touch = TapBench(built_in, {}, 600, 300, 1).touch(result);
  EXPECT_FALSE(well_rendered(touch, false));
  EXPECT_TRUE(std::isinf(touch.energy));
}

}  // namespace
}  // namespace limpid
