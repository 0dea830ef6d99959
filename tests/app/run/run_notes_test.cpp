#include "app/run/run_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "app/run/fitted_gains.h"
#include "devices/files/urdf_file.h"
#include "tests/support/built_in.h"

namespace limpid {
namespace {

using testing::HasSubstr;

TEST(RunNotes, HaveNothingAgainstTheSpringOfAnArmThatIsShipped) {
  int arms = 0;
  for (const auto& entry : std::filesystem::directory_iterator(LIMPID_ASSETS_DIR "/devices")) {
    if (entry.path().extension() != ".urdf") continue;
    ++arms;
    const ArmDescription arm = read_urdf(entry.path());
    EXPECT_EQ(weak_spring_text(arm, fitted(arm)), "") << entry.path();
  }
  EXPECT_GT(arms, 5);
}

// The fit follows the joint with the least damping, so that a pen's roll makes all springs weak.
TEST(RunNotes, SayThatASpringIsTooWeakForAJoint) {
  ArmDescription arm = test::omni();
  arm.joints[2].damping = 1e-6;
  Parameters p = fitted(arm);
  ASSERT_LT(p.k_vc, 0.01);
  for (const CouplingKind law :
       {CouplingKind::standard, CouplingKind::proposed, CouplingKind::predictive}) {
    p.kind = law;
    EXPECT_THAT(notes_on(arm, p), testing::ElementsAre(HasSubstr("coupling.k_vc is weak")));
  }
  p.kind = CouplingKind::direct;
  EXPECT_EQ(weak_spring_text(arm, p), "") << "it has no such spring";
  p.kind = CouplingKind::predictive;
  p.k_vc = 10;
  EXPECT_EQ(weak_spring_text(arm, p), "");
}

}  // namespace
}  // namespace limpid
