// The report of what an arm can render, against closed forms.
#include "app/experiments/characterize.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "app/base/folders.h"
#include "app/run/analysis.h"
#include "app/run/fitted_gains.h"
#include "app/run/tip_limits.h"
#include "devices/files/urdf_file.h"
#include "tests/support/temp_dir.h"

namespace limpid {
namespace {

using testing::HasSubstr;

Characterized built_in(int delay) {
  Characterized subject;
  subject.at.arm = read_urdf(default_device());
  subject.at.parameters = fitted(subject.at.arm);
  subject.at.parameters.device_delay = subject.at.parameters.delay = delay;
  subject.name = "the built-in arm";
  subject.numbers = {{"delay", "delay", "ms", 1.0 * delay, "a test said so", true}};
  return subject;
}

TipAlong tip_of(const ArmDescription& arm) {
  const ArmAt at = arm_at(arm, rest_pose(arm));
  const Eigen::VectorXd b = device_damping(arm, {});
  return tip_along(at.J, at.M, b, least_damped(at.J, b));
}

const LawRendered& of(const Characterization& found, CouplingKind kind) {
  return *std::ranges::find(found.laws, kind, &LawRendered::kind);
}

struct ACharacterization : testing::Test {
  Characterization of_built_in(int delay) {
    TrialRunner::Options options;
    options.dir = dir / ".";
    TrialRunner lab("characterize", options);
    return characterize(lab, built_in(delay));
  }

  test::TempDir dir;
};

TEST_F(ACharacterization, FindsTheWallsOfTheory) {
  const TipAlong tip = tip_of(built_in(0).at.arm);
  for (const int delay : {0, 1, 3}) {
    const Characterization found = of_built_in(delay);
    const WallSetting s{.hand_damping = kHands[0].damping, .delay = 1e-3 * delay};
    const double direct = of(found, CouplingKind::direct).wall / direct_wall(tip, s);
    EXPECT_GT(direct, 0.85) << delay;
    EXPECT_LT(direct, 1.25) << delay;
    EXPECT_LE(of(found, CouplingKind::eba).most_given(), 1e-9) << delay;
    EXPECT_TRUE(found.outcome.passed()) << delay;
    for (const Check& check : found.outcome.checks) EXPECT_TRUE(check.passed) << check.what;
  }
}

// Without friction and encoder steps a device's own mass and damping are felt under laws that
// command nothing in free motion.
TEST_F(ACharacterization, FindsMassAndDampingOfTheTip) {
  const TipAlong tip = tip_of(built_in(0).at.arm);
  const Characterization found = of_built_in(0);
  for (const CouplingKind kind : {CouplingKind::direct, CouplingKind::popc}) {
    const LawRendered& law = of(found, kind);
    ASSERT_EQ(law.free.size(), std::size(kFreeTold));
    for (const FeltMotion& felt : law.free) {
      EXPECT_NEAR(felt.inertia, tip.mass, 0.06 * tip.mass) << felt.f;
      EXPECT_NEAR(felt.damping, tip.damping, 0.06 * tip.damping) << felt.f;
    }
  }
}

TEST_F(ACharacterization, SaysWhatItStandsOnAndWhatEachLawRenders) {
  const Characterized subject = built_in(1);
  write_characterization(subject, of_built_in(1), dir / ".");
  std::ifstream page(dir / "report.html");
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  EXPECT_THAT(text, HasSubstr("assumed: a test said so"));
  const auto json = nlohmann::json::parse(std::ifstream(dir / "characterize.json"));
  EXPECT_TRUE(json.at("numbers").at(0).at("assumed"));
  EXPECT_EQ(json.at("laws").size(), kBenchLaws.size());
  EXPECT_EQ(json.at("laws").at(0).at("taps").size(), kHands.size());
  for (const BenchLaw& law : kBenchLaws) EXPECT_THAT(text, HasSubstr(info(law.kind).key));
}

}  // namespace
}  // namespace limpid
